"""Frames and tables as NumPy, xarray and pandas have them."""

import unittest
from pathlib import Path

import bedload
import h5py
import numpy as np
from bedload.results import Frames, Table, open_run
from support import folder


def write_frames(path, times, ids, field):
    """Frames of particles in any order; `field(id, time)` is their value, (id, time, 0) their place."""
    counts = [len(each) for each in ids]
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root["NumberOfPoints"] = counts
        root["Points"] = np.concatenate([[(i, t, 0) for i in each] for t, each in zip(times, ids)]).astype("f4")
        data, steps = root.create_group("PointData"), root.create_group("Steps")
        steps.attrs["NSteps"] = len(times)
        steps["Values"] = times
        steps["PointOffsets"] = np.cumsum([0, *counts[:-1]])
        steps["PartOffsets"] = np.arange(len(times))
        data["id"] = np.concatenate(ids).astype("u4")
        data["value"] = np.concatenate([[field(i, t) for i in each] for t, each in zip(times, ids)])
        data["value"].attrs["unit"] = "m/s"


def write_images(path, times):
    """Frames of 3 x 2 x 2 nodes; the value of node n is 100 t + n, its velocity (t, n, 0); `solid` never changes."""
    n = np.arange(12.0)
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["WholeExtent"] = [0, 2, 0, 1, 0, 1]
        root.attrs["Origin"], root.attrs["Spacing"] = [0.5, 0.0, -1.0], [0.5, 0.5, 0.5]
        data, steps = root.create_group("PointData"), root.create_group("Steps")
        steps.attrs["NSteps"] = len(times)
        steps["Values"] = times
        data["value"] = np.stack([(100 * t + n).reshape(2, 2, 3) for t in times])
        data["velocity"] = np.stack([np.stack([0 * n + t, n, 0 * n], 1).reshape(2, 2, 3, 3) for t in times])
        data["solid"] = (n % 2).astype("u4").reshape(1, 2, 2, 3)
        for name in data:
            steps[f"PointDataOffsets/{name}"] = np.arange(len(times)) * (name != "solid")


class Results(unittest.TestCase):
    def test_frames_of_nodes(self):
        with folder() as place:
            write_images(Path(place) / "fluid.vtkhdf", [0.0, 0.5, 1.0])
            frames = Frames(Path(place) / "fluid.vtkhdf")
            self.assertEqual((len(frames), frames.count(1)), (3, 12))
            np.testing.assert_array_equal(frames.read(2, "value"), 100 + np.arange(12))
            np.testing.assert_array_equal(frames.read(1, "velocity")[7], [0.5, 7, 0])
            np.testing.assert_array_equal(frames.read(2, "solid"), np.arange(12) % 2)
            places = frames.position(0)
            np.testing.assert_array_equal(places[[0, 1, 3, 11]], [[0.5, 0, -1], [1, 0, -1], [0.5, 0.5, -1], [1.5, 0.5, -0.5]])

    def test_frames_of_particles_that_come_and_go(self):
        ids = [[3, 0, 1], [1, 3, 4], [4, 1]]
        with folder() as place:
            write_frames(Path(place) / "fluid.vtkhdf", [0.0, 0.5, 1.0], ids, lambda i, t: 10.0 * i + t)
            frames = Frames(Path(place) / "fluid.vtkhdf")
            self.assertEqual((len(frames), frames.nearest(0.6), frames.unit("value")), (3, 1, "m/s"))
            np.testing.assert_array_equal(frames.by_id(0, "value"), [0, 10, 30])
            data = frames.to_xarray()
            self.assertEqual(data.sizes, {"time": 3, "particle": 4, "axis": 3})
            np.testing.assert_array_equal(data.particle, [0, 1, 3, 4])
            expected = [[0, 10, 30, np.nan], [np.nan, 10.5, 30.5, 40.5], [np.nan, 11, np.nan, 41]]
            np.testing.assert_array_equal(data.value, expected)
            np.testing.assert_array_equal(data.value.sel(particle=[1, 4]).isel(time=[2, 0]), [[11, 41], [10, np.nan]])
            np.testing.assert_array_equal(data.position.sel(axis="y").isel(time=-1, particle=1), 1.0)
            self.assertEqual(data.value.units, "m/s")
            gone, here = bedload.measures.residence_times(frames)
            self.assertEqual((gone.tolist(), here.tolist()), ([], [0.5]))
            with self.assertRaisesRegex(bedload.FileError, "has no array 'speed', only id, position, value"):
                frames.read(0, "speed")

    def test_frames_are_read_when_they_are_needed(self):
        with folder() as place:
            write_frames(Path(place) / "fluid.vtkhdf", [0.0, 1.0], [[1, 0], [0, 1]], lambda i, t: i + t)
            frames = Frames(Path(place) / "fluid.vtkhdf")
            read, plain = [], frames.read
            frames.read = lambda k, name: read.append((k, name)) or plain(k, name)
            data = frames.to_xarray()
            del read[:]
            np.testing.assert_array_equal(data.value[1], [1, 2])
            self.assertEqual([k for k, name in read if name == "value"], [1])

    def test_tables(self):
        with folder() as place:
            path = Path(place) / "probes" / "front.csv"
            path.parent.mkdir()
            path.write_text("time [s],front [m],note\n0,0.1,a\n0.5,0.2,b\n")
            table = open_run(place).probes["front"]
            np.testing.assert_array_equal(table["front"], [0.1, 0.2])
            self.assertEqual((table.names(), table.header[0]), (["time", "front", "note"], "time [s]"))
            self.assertEqual([table.unit(name) for name in table.names()], ["s", "m", ""])
            frame = table.to_pandas()
            self.assertEqual((list(frame), frame.index.name), (["front"], "time"))
            self.assertEqual(frame.attrs["units"], {"time": "s", "front": "m"})
            self.assertEqual(open_run(place).status, "unfinished")
            with self.assertRaisesRegex(bedload.FileError, "is not numeric"):
                Table(path).column("note")
            with self.assertRaisesRegex(bedload.FileError, "has no case.resolved.toml"):
                open_run(place).case


if __name__ == "__main__":
    unittest.main()
