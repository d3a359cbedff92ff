#!/usr/bin/env python3
"""compare.py, plot.py, render.py and splat.py on small runs made here, whose answers are known; validate.py with a program that
takes the place of the solver; solids of solids.py."""

import contextlib
import io
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "tools"
sys.path[:0] = [str(TOOLS), str(ROOT / "cases" / "agitated_tube"), str(ROOT / "cases" / "rotating_drum")]
import bed  # noqa: E402
import compare  # noqa: E402
import outlines  # noqa: E402
import phases  # noqa: E402
import plot  # noqa: E402
import render  # noqa: E402
import rolling  # noqa: E402
import solids  # noqa: E402
import splat  # noqa: E402
import validate  # noqa: E402
from scene import Scene  # noqa: E402
from bedload import _surfaces  # noqa: E402


def write_frames(path, times, points, fields):
    """A VTKHDF file: `points` [frame][n, 3], `fields` name -> [frame][n, ...]."""
    counts = [len(p) for p in points]
    offsets = np.concatenate([[0], np.cumsum(counts)[:-1]])
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        root["NumberOfPoints"] = counts
        root["Points"] = np.concatenate(points).astype("f4")
        data, steps = root.create_group("PointData"), root.create_group("Steps")
        steps.attrs["NSteps"] = len(times)
        steps["Values"] = np.asarray(times, float)
        steps["PointOffsets"] = offsets
        steps["PartOffsets"] = np.arange(len(times))
        for name, frames in fields.items():
            data[name] = np.concatenate(frames)
            steps[f"PointDataOffsets/{name}"] = offsets


def tool(name, *arguments):
    command = [sys.executable, TOOLS / name, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def direct(main, *arguments):
    """As tool, of a main that takes arguments: saves loading what it is made of again."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main([str(a) for a in arguments]) or 0
        except SystemExit as stop:
            status = stop.code if isinstance(stop.code, int) else 2
            err.write(stop.code if isinstance(stop.code, str) else "")
    return status, out.getvalue(), err.getvalue()


class Folders(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.case, self.run_dir = Path(self.folder.name) / "case", Path(self.folder.name) / "run"
        self.case.mkdir()
        (self.run_dir / "probes").mkdir(parents=True)

    def tearDown(self):
        self.folder.cleanup()

    def compare(self, check):
        (self.case / "expect.toml").write_text("[[check]]\nname = 'it'\n" + check)
        return direct(compare.main, self.case, self.run_dir)


class Compare(Folders):
    def setUp(self):
        super().setUp()
        t = np.linspace(0, 1, 101)
        rows = "".join(f"{a},{1 + a * a}\n" for a in t)
        (self.run_dir / "probes" / "front.csv").write_text("time [s],front [m]\n" + rows)
        # The reference is the same curve, 0.1 s late and 2 % larger.
        late = "".join(f"run,{a + 0.1},{1.02 * (1 + a * a)}\n" for a in t[10:90:10])
        (self.case / "reference.csv").write_text("series,t_s,x_m\nother,0.2,9\n" + late)

    CURVE = """kind = "curve"
data = "probes/front.csv"
column = "front"
reference = "reference.csv"
reference_x = "t_s"
reference_y = "x_m"
where = { series = "run" }
relative = true
"""

    def test_curve_finds_the_delay(self):
        status, out, _ = self.compare(self.CURVE + "shift = [0, 0.2]\nrms = 0.021\nmax = 0.03")
        self.assertEqual(status, 0, out)
        self.assertIn("pass  it: RMS", out)
        status, out, _ = self.compare(self.CURVE + "rms = 0.021")
        self.assertEqual(status, 1, out)
        self.assertIn("FAIL  it", out)

    def test_curve_refuses_a_run_that_ends_early(self):
        (self.case / "reference.csv").write_text("series,t_s,x_m\nrun,0.5,1.25\nrun,1.5,3.25\n")
        status, out, _ = self.compare(self.CURVE + "rms = 0.5")
        self.assertEqual(status, 1)
        self.assertIn("the run ends at 1, the reference at 1.5", out)

    def test_advice_does_not_fail(self):
        status, out, _ = self.compare(self.CURVE + "rms = 0.001\nadvice = true")
        self.assertEqual(status, 0)
        self.assertIn("note  it", out)

    def test_value(self):
        value = 'kind = "value"\ndata = "probes/front.csv"\ncolumn = "front"\n'
        self.assertEqual(self.compare(value + "low = 1.99\nhigh = 2.01")[0], 0)
        self.assertEqual(self.compare(value + "low = 2.01")[0], 1)
        above = value + 'statistic = "first_above"\nthreshold = 1.25\n'
        self.assertEqual(self.compare(above + "low = 0.5\nhigh = 0.52")[0], 0)
        self.assertEqual(self.compare(above + "high = 0.5")[0], 1)
        self.assertEqual(self.compare(above.replace("1.25", "3") + "high = 0.5")[0], 1)
        self.assertEqual(self.compare(value + 'statistic = "mean"\ntime_range = [0.9, 1]\nlow = 1.9')[0], 0)

        slope = value + 'statistic = "slope"\n'  # of 1 + t2
        self.assertEqual(self.compare(slope + "time_range = [0, 1]\nlow = 0.999\nhigh = 1.001")[0], 0)
        self.assertEqual(self.compare(slope + "time_range = [0, 0]\nlow = 0")[0], 1)

    def test_growth_is_fitted_within_a_range_of_values(self):
        t = np.linspace(0, 2, 41)
        y = np.where(0.01 * np.exp(3 * t) < 0.1, 0.01 * np.exp(3 * t), 0.5)  # and then it saturates
        y[:3] = 0.019  # before, it is noise
        rows = "".join(f"{a},{b}\n" for a, b in zip(t, y))
        (self.run_dir / "probes" / "wave.csv").write_text("time [s],amplitude [m]\n" + rows)
        growth = 'kind = "decay"\ndata = "probes/wave.csv"\ncolumn = "amplitude"\ntolerance = 0.01\nrate = -3\n'
        self.assertEqual(self.compare(growth + "value_range = [0.02, 0.1]")[0], 0)
        self.assertEqual(self.compare(growth)[0], 1)

    def test_falls(self):
        (self.run_dir / "probes" / "energy.csv").write_text("time [s],a [J],b [J]\n0,3,0\n1,2,0.5\n2,1,1.6\n3,1,0\n")
        falls = 'kind = "falls"\ndata = "probes/energy.csv"\n'
        self.assertEqual(self.compare(falls + 'column = "a"')[0], 0)
        status, out, _ = self.compare(falls + 'column = ["a", "b"]')
        self.assertEqual(status, 1, out)
        self.assertIn("rises by at most 0.1 (<= 0), at t = 2", out)
        self.assertEqual(self.compare(falls + 'column = ["a", "b"]\nslack = 0.11')[0], 0)

    def test_below(self):
        (self.run_dir / "probes" / "slow.csv").write_text("time [s],front [m]\n0,1\n1,1.5\n")
        below = 'kind = "below"\ndata = "probes/{}.csv"\ncolumn = "front"\nother_data = "probes/{}.csv"\n' \
                'other_column = "front"\n'
        self.assertEqual(self.compare(below.format("slow", "front") + "slack = 0.07")[0], 0)
        self.assertEqual(self.compare(below.format("front", "slow") + "slack = 0.07")[0], 1)

    def test_says_what_it_cannot_evaluate(self):
        status, _, err = self.compare('kind = "value"\ndata = "probes/front.csv"\ncolumn = "fornt"\nlow = 1')
        self.assertEqual(status, 2)
        self.assertIn("has no column 'fornt', only time [s], front [m]", err)
        status, _, err = self.compare('kind = "value"\ndata = "probes/none.csv"\ncolumn = "front"\nlow = 1')
        self.assertEqual(status, 2)
        self.assertIn("No such file", err)


class CompareFrames(Folders):
    def setUp(self):
        super().setUp()
        times = np.linspace(0, 2, 21)
        z = np.linspace(0, 1, 50)
        points = [np.stack([0 * z, 0 * z, z], 1) for _ in times]
        flow = [np.stack([z * (1 - z) * np.exp(-0.5 * t), 0 * z, 0 * z], 1).astype("f4") for t in times]
        write_frames(self.run_dir / "fluid.vtkhdf", times, points, {"velocity": flow})
        rows = "".join(f"{a},{a * (1 - a) * np.exp(-0.5)}\n" for a in np.linspace(0, 1, 201))
        (self.case / "profile.csv").write_text("z_m,v_m_s\n" + rows)

    def test_positions(self):
        place = 'kind = "value"\ndata = "fluid.vtkhdf"\nfield = "position"\ncomponent = 2\n'
        self.assertEqual(self.compare(place + 'reduce = 0.9\nlow = 0.899\nhigh = 0.901')[0], 0)
        # of 50 places evenly along 0..1
        self.assertEqual(self.compare(place + 'reduce = "deviation"\nlow = 0.2944\nhigh = 0.2946')[0], 0)
        status, _, err = self.compare(place + 'reduce = "median"\nlow = 0')
        self.assertEqual(status, 2)
        self.assertIn("reduce = 'median' must be one of mean, max", err)

    def test_profile(self):
        profile = 'kind = "profile"\ndata = "fluid.vtkhdf"\nfield = "velocity"\ncomponent = 0\nalong = 2\n' \
                  'reference = "profile.csv"\nreference_x = "z_m"\nreference_y = "v_m_s"\n' \
                  'scale = 0.15\nmax = 0.01\n'
        status, out, _ = self.compare(profile + "time = 1.0")
        self.assertEqual(status, 0, out)
        self.assertIn("at t = 1 s", out)
        self.assertEqual(self.compare(profile + "time = 0.5")[0], 1)

    def test_decay(self):
        decay = 'kind = "decay"\ndata = "fluid.vtkhdf"\nfield = "velocity"\nreduce = "mean_square"\n' \
                'tolerance = 0.01\n'
        self.assertEqual(self.compare(decay + "rate = 1.0")[0], 0)
        self.assertEqual(self.compare(decay + "rate = 1.02")[0], 1)


class Plot(Folders):
    CASE = """title = "A drop over a step"
[domain]
min = [0, 0, 0]
max = [0.2, 0.1, 0.1]
periodic = [false, true, false]
[fluid]
dx = 0.005
[grain]
d = 0.01
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.2, 0.1, 0.1]
faces = ["x-", "x+", "z-"]
[[wall.body]]
name = "gate"
shape = "box"
min = [0.1, 0, 0]
max = [0.11, 0.1, 0.08]
motion.kind = "velocity"
motion.velocity = [0, 0, 0.5]
[[wall.body.motion.add]]
kind = "table"
rows = [[0, 0, 0, 0], [0.1, 0.01, 0, 0, 0, 0, 20]]
[[wall.body]]
name = "step"
shape = "step"
[[shape]]
name = "lump"
kind = "mesh"
file = "lump.stl"
[[shape]]
name = "pipe"
kind = "pipe"
a = [0.1, 0, 0.02]
b = [0.1, 0.1, 0.02]
radius = 0.01
thickness = 0.002
ends = "closed_b"
[[shape]]
name = "step"
kind = "union"
of = ["lump", "pipe"]
turn_axis = [0, 1, 0]
turn_angle = 5
"""

    def setUp(self):
        super().setUp()
        random = np.random.default_rng(1)
        box = np.array([0.1, 0.1, 0.08])
        points = [random.random((500, 3)) * box for _ in range(3)]
        write_frames(self.run_dir / "fluid.vtkhdf", [0, 0.1, 0.2], points,
                     {"velocity": [random.random((500, 3)) for _ in range(3)],
                      "pressure": [random.random(500) for _ in range(3)]})
        write_frames(self.run_dir / "grains.vtkhdf", [0, 0.1, 0.2], [p[:20] for p in points],
                     {"radius": [np.full(20, 0.005)] * 3})

    def expect_picture(self, *arguments):
        out = Path(self.folder.name) / "out" / "picture.png"
        status, _, err = tool("plot.py", *arguments, "--out", out)
        self.assertEqual(status, 0, err)
        self.assertEqual(out.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_frames(self):
        (self.run_dir / "case.resolved.toml").write_text(self.CASE)
        solids.hopper(radius=0.02, orifice=0.01, height=0.05).write_stl(self.run_dir / "lump.stl")
        self.expect_picture("frames", self.run_dir, "--times", "0,0.1,0.2")
        self.expect_picture("frames", self.run_dir, "--field", "pressure", "--slice", "0.05")

    def test_bodies_stand_where_their_particles_are(self):
        (self.run_dir / "case.resolved.toml").write_text(self.CASE)
        placed = np.random.default_rng(2).random((30, 3))
        turned = _surfaces.rotation([0, 0, 1], 0.3)
        order = np.random.default_rng(3).permutation(30)  # frames keep no order
        write_frames(self.run_dir / "walls.vtkhdf", [0, 0.1], [placed, (placed @ turned.T)[order]],
                     {"body": [np.ones(30), np.ones(30)], "id": [np.arange(30), order]})
        _, turn, shift = list(plot.Run(self.run_dir, "xz").bodies(0.1))[1]
        np.testing.assert_allclose(turn, turned, atol=1e-5)
        np.testing.assert_allclose(shift, 0, atol=1e-5)

    def test_running_means_and_spectra(self):
        table = self.run_dir / "gauge.csv"
        rows = [f"{t},{np.sin(20 * t)}" for t in np.arange(0, 3, 0.01)]
        table.write_text("time [s],height [m]\n" + "\n".join(rows) + "\n")
        self.expect_picture("probe", table, "--mean", "0.3")
        self.expect_picture("probe", table, "--spectrum")
        status, _, err = tool("plot.py", "probe", table, "--mean", "-1", "--out", "none.png")
        self.assertEqual(status, 2)
        self.assertIn("--mean -1 must be above 0 s", err)
        table.write_text("time [s],height [m]\n" + "\n".join(rows[:5]) + "\n")
        status, _, err = tool("plot.py", "probe", table, "--spectrum", "--out", "none.png")
        self.assertNotEqual(status, 0)
        self.assertIn("a spectrum needs 8 values or more; there are 5", err)

    def test_scaling(self):
        report = self.run_dir / "speed.json"
        row = {"row": "1M", "precision": "mixed", "scaling": "strong", "ranks": 2, "speed_up": 1.8,
               "efficiency_percent": 90, "wait_percent": 4}
        one = {**row, "ranks": 1, "speed_up": 1, "efficiency_percent": 100, "wait_percent": 0}
        weak = [{**each, "scaling": "weak"} for each in (row, one)]
        rows = [row, one, *weak, {"row": "1M", "precision": "double"}]
        series = plot.scaling_series({"rows": rows})
        self.assertEqual([[r["ranks"] for r in rows] for rows in series.values()], [[1, 2], [1, 2]])
        report.write_text(json.dumps({"device": "GPU", "commit": "1", "rows": rows}))
        self.expect_picture("scaling", report)
        report.write_text(json.dumps({"device": "GPU", "commit": "1", "rows": rows[-1:]}))
        status, _, err = tool("plot.py", "scaling", report, "--out", "none.png")
        self.assertNotEqual(status, 0)
        self.assertIn("has no rows of scaling", err)

    def test_drag_laws(self):
        table = self.run_dir / "drag.csv"
        header = "solid_fraction,reynolds,measured,least,most,beetstra07,tang15,wen_yu\n"
        table.write_text("# by bedload drag\n" + header + "0.3,0.1,5,4.9,5.2,5,5,3\n0.3,10,7,6.9,7.2,7,7,4\n"
                         "0.3,1,nan,nan,nan,5.5,5.5,3.2\n")
        self.expect_picture("drag-laws", table, table)
        table.write_text("solid_fraction,wen_yu\n0.3,1\n")
        status, _, err = tool("plot.py", "drag-laws", table, "--out", "none.png")
        self.assertNotEqual(status, 0)
        self.assertIn("must begin with the columns solid_fraction, reynolds", err)

    def test_frames_without_the_case(self):
        self.expect_picture("frames", self.run_dir, "--times", "0.2", "--view", "yz")

    def test_field_that_is_not_there(self):
        status, _, err = tool("plot.py", "frames", self.run_dir, "--field", "porosity", "--out", "none.png")
        self.assertNotEqual(status, 0)
        self.assertIn("has no porosity, only position, pressure, velocity", err)

    def test_time_that_is_not_there(self):
        status, _, err = tool("plot.py", "frames", self.run_dir, "--times", "0.1,0.3", "--out", "none.png")
        self.assertNotEqual(status, 0)
        self.assertIn("--times: 0.3 s is not in this run, which has frames from 0 to 0.2 s", err)

    def test_window_holds_the_grains(self):
        (self.run_dir / "case.resolved.toml").write_text(self.CASE)
        heap = np.array([[0.3, 0.05, 0.0], [0.05, 0.05, -0.2]])
        write_frames(self.run_dir / "grains.vtkhdf", [0, 0.1], [heap, heap], {"radius": [np.full(2, 0.005)] * 2})
        low, high = plot.Run(self.run_dir, "xz").window([0.1])
        self.assertLess(low[1], -0.2)
        self.assertGreater(high[0], 0.3)

    def test_axes_name_quantity_and_unit(self):
        self.assertEqual(plot.axis_label(["force_by_fluid_x [N]", "force_by_fluid_y [N]"]), "force by fluid (N)")
        self.assertEqual(plot.axis_label(["height [m]", "column_depth [m]"]), "height, column depth (m)")
        self.assertEqual(plot.axis_label([f"{k}_force_{a} [N]" for k in "pqrs" for a in "xyz"]), "force (N)")
        self.assertEqual(plot.axis_label(["a [-]", "b [-]", "c [-]", "d [-]"]), "values (-)")
        self.assertEqual(plot.axis_label(["t"]), "t")

    def test_each_unit_has_its_panel(self):
        table = self.run_dir / "diagnostics.csv"
        table.write_text("time [s],mass [kg],speed [m/s],fast [m/s]\n0,1,2,3\n1,2,3,4\n")
        self.expect_picture("probe", table)
        self.assertEqual([plot.unit_of(n) for n in ("mass [kg]", "fast [m/s]", "t")], ["kg", "m/s", ""])

    def test_probe(self):
        table = self.run_dir / "probes" / "front.csv"
        table.write_text("time [s],front [m]\n0,1\n1,2\n")
        reference = self.case / "reference.csv"
        reference.write_text("series,t_s,x_m\nA,0.5,1.4\nB,0.7,1.8\n")
        self.expect_picture("probe", table, "--reference", reference)


class Render(Folders):
    CASE = """[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[fluid]
dx = 0.01
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
faces = ["x-", "x+", "y-", "y+", "z-"]
"""

    def setUp(self):
        super().setUp()
        (self.run_dir / "case.resolved.toml").write_text(self.CASE)
        place = (np.arange(10) + 0.5) * 0.01
        self.block = np.array(np.meshgrid(place, place, place[:5])).reshape(3, -1).T
        lone = np.array([[0.05, 0.05, 0.095]])
        water = np.concatenate([self.block, lone])
        flow = np.zeros_like(water)
        flow[:, 0] = water[:, 2]
        write_frames(self.run_dir / "fluid.vtkhdf", [0, 0.1, 0.2], [water] * 3,
                     {"velocity": [flow] * 3, "pressure": [np.ones(len(water))] * 3})

    def picture(self, frame=0, **chosen):
        look = {"size": (160, 120), "fluid": "surface", "colour": "speed", "limits": None, "camera": None, "clip": None,
                "walls": True}
        return render.Picture(Scene(self.run_dir), [frame], **look | chosen)

    def test_surface_lies_half_a_spacing_beyond_the_particles(self):
        mesh, alone, _ = self.picture().surface(0)
        low, high = np.array(mesh.bounds).reshape(3, 2).T
        np.testing.assert_allclose(low, 0, atol=0.003)
        np.testing.assert_allclose(high, [0.1, 0.1, 0.05], atol=0.003)
        np.testing.assert_allclose(alone, [[0.05, 0.05, 0.095]], atol=1e-6)
        inner = np.abs(mesh.points[:, 2] - 0.025) < 0.002  # speed is the height
        self.assertGreater(inner.sum(), 10)
        np.testing.assert_allclose(mesh["field"][inner], mesh.points[inner, 2], atol=0.002)

    def test_clip_leaves_out_what_is_nearer(self):
        mesh, _, _ = self.picture(clip=(1, 0.05)).surface(0)  # seen from -y
        self.assertGreater(mesh.bounds[2], 0.045)

    MILL = """[[shape]]
name = "inside"
kind = "cylinder"
a = [0.05, 0, 0.05]
b = [0.05, 0.1, 0.05]
radius = 0.04
[[shape]]
name = "shell"
kind = "hollow"
of = ["inside"]
thickness = 0.01
[[shape]]
name = "lifter"
kind = "box"
min = [0.08, 0, 0.045]
max = [0.095, 0.1, 0.055]
[shape.copies]
count = 4
about = [0, 1, 0]
centre = [0.05, 0, 0.05]
[[shape]]
name = "mill"
kind = "union"
of = ["shell", "lifter"]
[[wall.body]]
name = "mill"
shape = "mill"
[wall.body.motion]
kind = "rotation"
axis = [0, 1, 0]
centre = [0.05, 0, 0.05]
rate = 1
"""

    def add_to_case(self, text):
        (self.run_dir / "case.resolved.toml").write_text(self.CASE + text)

    def table(self, body, rows):
        (self.run_dir / "bodies").mkdir(exist_ok=True)
        names = ["time [s]", *(f"centre_{k} [m]" for k in "xyz"), *(f"rotation_{k} [-]" for k in "wxyz"), "present [-]"]
        text = "\n".join(",".join(map(str, row)) for row in [names, *rows])
        (self.run_dir / "bodies" / f"{body}.csv").write_text(text + "\n")

    def test_a_vessel_with_lifters_is_glass_with_solid_lifters(self):
        self.add_to_case(self.MILL)
        drawn = [(mesh, how) for mesh, how in self.picture().solids(0)][1:]  # after the tank
        self.assertEqual([how for _, how in drawn], ["vessel"] + ["machine"] * 4)
        from_axis = [np.hypot(mesh.points[:, 0] - 0.05, mesh.points[:, 2] - 0.05) for mesh, _ in drawn]
        self.assertLess(max(r.max() for r in from_axis[1:]), 0.0401)  # none reaches into the shell
        self.assertLess(drawn[0][0].area, 2 * np.pi * 0.04 * (0.04 + 0.1) - 3.9 * 0.01 * 0.1)  # nor it into them
        for mesh, _ in drawn[1:]:
            self.assertAlmostEqual(mesh.area, 2 * 0.01 * 0.1 / 2 + 2 * 0.01 * 0.1, delta=5e-4)

    def test_clip_cuts_every_wall_and_shows_sections(self):
        self.add_to_case(self.MILL)
        drawn = list(self.picture(clip=(1, 0.05)).solids(0))  # seen from -y
        self.assertEqual([how for _, how in drawn].count("cut"), 1)
        for mesh, how in drawn:
            self.assertGreater(mesh.bounds[2], 0.0499, how)
        ring = np.pi * (0.05**2 - 0.04**2)
        lifters = 4 * 0.01 * 0.01
        self.assertAlmostEqual(drawn[-1][0].area, ring + lifters, delta=0.03 * ring)

    def test_a_difference_is_drawn_without_what_it_lacks(self):
        self.add_to_case("""[[shape]]
name = "block"
kind = "box"
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[[shape]]
name = "bore"
kind = "cylinder"
a = [0.05, -0.01, 0.05]
b = [0.05, 0.11, 0.05]
radius = 0.025
[[shape]]
name = "rest"
kind = "difference"
of = ["block", "bore"]
[[wall.body]]
name = "rest"
shape = "rest"
""")
        drawn = [mesh for mesh, _ in self.picture().solids(0)][1:]
        area = 6 * 0.1**2 - 2 * np.pi * 0.025**2 + 2 * np.pi * 0.025 * 0.1
        self.assertAlmostEqual(sum(mesh.area for mesh in drawn) / area, 1, delta=0.01)

    def test_bodies_stand_where_their_tables_say_while_they_are_there(self):
        self.add_to_case(self.MILL)
        half = np.sqrt(0.5)  # a quarter turn about y
        self.table("mill", [[0, 0.05, 0, 0.05, 1, 0, 0, 0, 1], [0.1, 0.05, 0, 0.05, half, 0, half, 0, 1],
                            [0.2, 0.05, 0, 0.05, half, 0, half, 0, 0]])
        scene = Scene(self.run_dir)
        names = [[body["name"] for body, _, _ in scene.bodies(t)] for t in (0, 0.1, 0.2)]
        self.assertEqual(names, [["tank", "mill"], ["tank", "mill"], ["tank"]])
        _, turn, shift = list(scene.bodies(0.1))[1]
        np.testing.assert_allclose(turn @ [0.09, 0, 0.05] + shift, [0.05, 0, 0.01], atol=1e-12)
        self.assertLess(len(list(self.picture().solids(0.2))), len(list(self.picture().solids(0.1))))

    def test_copies_stand_about_their_axis_and_in_a_row(self):
        rod = {"kind": "box", "min": [0.9, -1, -0.1], "max": [1, 1, 0.1]}
        about = {"it": rod | {"copies": {"count": 4, "about": [0, 1, 0], "centre": [0, 0, 0], "angle": 90}}}
        meshes = _surfaces.surfaces("it", about, Path())
        self.assertEqual(len(meshes), 4)
        np.testing.assert_allclose(meshes[1].vertices.mean(0), [0, 0, -0.95], atol=1e-12)
        row = {"it": rod | {"copies": {"count": 3, "along": [0, 0, 0.5]}}}
        np.testing.assert_allclose(_surfaces.surfaces("it", row, Path())[2].vertices.mean(0), [0.95, 0, 1], atol=1e-12)

    def test_grains_take_colours_of_a_field(self):
        speed = np.zeros((5, 3))
        speed[:, 0] = np.arange(5)
        write_frames(self.run_dir / "grains.vtkhdf", [0, 0.1, 0.2], [self.block[:5] + [0, 0, 0.045]] * 3,
                     {"radius": [np.full(5, 0.01)] * 3, "velocity": [speed] * 3})
        picture = self.picture(grain_colour="speed", colour="none", fluid="points")
        np.testing.assert_allclose(picture.grain_values(0), np.arange(5))
        self.assertEqual(picture.grain_limits[0], 0)
        self.assertGreater(picture.grain_limits[1], 3.5)
        equal = self.picture(grain_colour="diameter")
        np.testing.assert_allclose(equal.grain_values(0), 0.02)
        np.testing.assert_allclose(equal.grain_limits, [0.02, 0.022])  # a scale nevertheless
        plain, coloured = (np.asarray(self.picture(grain_colour=c, colour="none").draw(0)) for c in ("none", "speed"))
        self.assertGreater(np.abs(plain.astype(int) - coloured).max(), 80)
        status, _, err = direct(render.main, self.run_dir, "--grain-colour", "spin", "--out", "none.png")
        self.assertEqual(status, 2)
        self.assertIn("has no angular_velocity, only position, radius, velocity", err)

    def test_smooth_bodies_have_no_edges_to_draw(self):
        ball = '[[shape]]\nname = "ball"\nkind = "sphere"\ncentre = [0.05, 0.05, 0.05]\nradius = 0.02\n'
        body = '[[wall.body]]\nname = "ball"\nshape = "ball"\n[wall.body.free]\ndensity = 500\n'
        (self.run_dir / "case.resolved.toml").write_text(self.CASE + ball + body)
        self.assertGreater(np.asarray(self.picture().draw(0)).std(), 1)

    def test_pictures_show_fluid_and_grains(self):
        write_frames(self.run_dir / "grains.vtkhdf", [0, 0.1, 0.2], [self.block[:5] + [0, 0, 0.045]] * 3,
                     {"radius": [np.full(5, 0.01)] * 3})
        out = Path(self.folder.name) / "it.png"
        for call, program, speed in (tool, "render.py", []), (direct, splat.main, ["--range", "0,0.1"]):
            status, _, err = call(program, self.run_dir, "--out", out, "--size", "300,200", "--time", "0.1", *speed)
            self.assertEqual(status, 0, err)
            pixels = np.asarray(Image.open(out).convert("RGB")).astype(int)
            self.assertEqual(pixels.shape, (200, 300, 3))
            red, blue = (pixels[:, :, k] - pixels[:, :, 2 - k] for k in (0, 2))
            self.assertGreater((blue > 40).sum(), 2000)  # water
            self.assertGreater((red > 40).sum(), 50)  # grains

    def test_film_has_a_picture_for_each_frame(self):
        film = Path(self.folder.name) / "it.gif"
        status, _, err = direct(render.main, self.run_dir, "--film", film, "--size", "96,64", "--fluid", "points")
        self.assertEqual(status, 0, err)
        with Image.open(film) as frames:
            self.assertIn(frames.n_frames, (1, 3))  # equal pictures may become one
        film = film.with_suffix(".mp4")
        status, _, err = direct(render.main, self.run_dir, "--film", film, "--size", "96,64", "--no-walls")
        self.assertEqual(status, 0, err)
        self.assertEqual(film.read_bytes()[4:8], b"ftyp")

    def test_says_what_is_wrong(self):
        for arguments, text in ((["--time", "3"], "--time 3: this run has frames from 0 to 0.2 s"),
                                (["--frame", "7"], "--frame 7: this run has frames 0 to 2"),
                                (["--colour", "porosity"], "has no grains and so no porosity"),
                                (["--camera", "left"], "'left' must be 2 to 3 numbers with commas between them"),
                                (["--film", "it.avi"], "'it.avi' must end in .mp4 or .gif")):
            status, _, err = direct(render.main, self.run_dir, *arguments)
            self.assertEqual(status, 2)
            self.assertIn(text, err)
        look = self.case / "look.toml"
        look.write_text("[picture]\ncamra = [0, 0]\n")
        status, _, err = tool("render.py", self.run_dir, "--like", look)
        self.assertEqual(status, 2)
        self.assertIn("[picture] has no 'camra', only fluid, colour", err)


class Validate(Folders):
    PROGRAM = """#!/usr/bin/env python3
# Takes the place of the solver: h(t) = 1 + dx^2 + t, and a case named broken.
import json, sys
from pathlib import Path
case, out = Path(sys.argv[2]), Path(sys.argv[4])
with open(Path(__file__).parent / "calls", "a") as calls:
    calls.write(out.name + "\\n")
if case.parent.name == "broken":
    sys.exit(3)
settings = dict(word.split("=") for before, word in zip(sys.argv, sys.argv[1:]) if before == "--set")
dx = float(settings.get("fluid.dx", 0.1))
out.mkdir(parents=True, exist_ok=True)
(out / "h.csv").write_text("time [s],h [m]\\n" + "".join(f"{t / 10},{1 + dx**2 + t / 10}\\n" for t in range(11)))
(out / "summary.json").write_text(json.dumps({"wall_time": {"value": 2.5}, "device": {"name": "a device"},
                                              "precision": "mixed", "counts": {"fluid": 12}}))
"""
    EXPECT = """proves = "that {0} rises"
quick = {1}
[convergence]
check = "rise"
quick = [0.4, 0.2, 0.1]
[[check]]
name = "rise"
kind = "value"
data = "h.csv"
column = "h"
exact = 2.0
low = 1.99
high = {2}
"""

    def setUp(self):
        super().setUp()
        self.root, self.cases = Path(self.folder.name), Path(self.folder.name) / "cases"
        self.program = self.root / "program"
        self.program.write_text(self.PROGRAM)
        self.program.chmod(0o755)
        for name, quick, high in (("broken", "true", 3), ("good", "true", 2.02), ("bad", "true", 2.001),
                                  ("long", "false", 3)):
            (self.cases / name).mkdir(parents=True)
            (self.cases / name / "case.toml").write_text("")
            (self.cases / name / "expect.toml").write_text(self.EXPECT.format(name, quick, high))
        fitted = self.cases / "good" / "expect_fitted.toml"
        fitted.write_text('case = "case.toml"\ncalibrated = "h"\n' + self.EXPECT.format("h", "true", 2.02))

    def validate(self, *arguments):
        return direct(validate.main, "--cases", self.cases, "--program", self.program, "--out", self.root / "out",
                    *arguments)

    def calls(self):
        return (self.root / "calls").read_text().split()

    def test_report(self):
        status, out, err = self.validate()
        self.assertEqual(status, 1, out + err)  # one could not be run
        self.assertIn("4 entries: 1 pass, 1 calibrated, 1 miss, 1 not run.", out)
        table = (self.root / "out" / "report.md").read_text()
        self.assertIn("| bad | that bad rises | - | rise: final 2.01 (within 1.99 .. 2.001) | 0 of 1 | **miss** "
                      "| 2.5 s | 12 fluid | a device | mixed |", table)
        self.assertIn("the simulation failed", table)
        self.assertIn("| good | rise | 0.1 | 5.000e-03 | 2.00 | 2.5 s |", table)
        self.assertNotIn("long", table)
        page = (self.root / "out" / "report.html").read_text()
        self.assertEqual(page.count("data:image/png;base64,"), 6)  # a check and a convergence each
        self.assertNotIn("src='http", page)
        self.assertLess(len(page), 500_000)

    def test_does_not_run_again_what_it_has(self):
        self.validate("--only", "good")
        self.assertEqual(self.calls(), ["good_case", "good_case_0.4", "good_case_0.2", "good_case_0.1"])
        self.validate("--only", "good")
        self.assertEqual(len(self.calls()), 4)
        (self.cases / "good" / "case.toml").write_text("# other\n")
        self.validate("--only", "good", "--no-convergence")
        self.assertEqual(self.calls()[4:], ["good_case"])
        self.program.write_text(self.PROGRAM + "# other\n")
        self.validate("--only", "good", "--no-convergence")
        self.assertEqual(self.calls()[5:], ["good_case"])

    def test_says_what_is_wrong(self):
        status, _, err = self.validate("--only", "god")
        self.assertEqual(status, 2)
        self.assertIn("--only god: no such case; it must be one of bad, broken, good", err)
        (self.cases / "bad" / "expect.toml").write_text("porves = 'x'\n" + self.EXPECT.format("x", "true", 3))
        status, _, err = self.validate()
        self.assertEqual(status, 2)
        self.assertIn("expect.toml: unknown key 'porves'; it must be one of check, proves", err)

    def test_cases_can_be_told_of(self):
        found = [validate.Entry(path, ROOT / "cases") for path in (ROOT / "cases").glob("*/expect*.toml")]
        self.assertGreater(len(found), 30)
        for entry in found:
            self.assertTrue(entry.case.is_file(), entry.path)
            self.assertIn("proves", entry.header, entry.path)
            self.assertIn("quick", entry.header, entry.path)
            render.settings(entry.path)
            for script in entry.header.get("measure", []):
                self.assertTrue((entry.folder / script.split()[0]).is_file(), entry.path)
            for spec in entry.header["check"]:
                if "reference" in spec:
                    self.assertTrue((entry.folder / spec["reference"]).is_file(), entry.path)
            if "convergence" in entry.header:
                checks = [spec["name"] for spec in entry.header["check"]]
                self.assertIn(entry.header["convergence"]["check"], checks)


class Solids(unittest.TestCase):
    def expect_closed(self, mesh, volume, tolerance):
        edges = np.concatenate([mesh.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
        count = len(mesh.vertices)
        there, back = edges @ [count, 1], edges @ [1, count]
        self.assertEqual(len(np.unique(there)), len(there))  # no edge twice in one direction
        np.testing.assert_array_equal(np.sort(there), np.sort(back))
        self.assertLess(abs(mesh.volume() / volume - 1), tolerance)

    def test_hopper(self):
        mesh = solids.hopper(facets=500)
        r, z = np.array([[0.008, 0], [0.008 + 0.003 * np.sqrt(2), 0], [0.028, 0.0157574], [0.028, 0.08],
                         [0.025, 0.08], [0.025, 0.017]]).T
        s, y = np.roll(r, -1), np.roll(z, -1)
        self.expect_closed(mesh, np.pi / 3 * np.sum((r * y - s * z) * (r + s)), 1e-3)

    def test_impellers(self):
        for kind, hub in (("rushton", 0.015), ("paddle", 0.015), ("pitched", 0.025)):
            thickness = 0.003
            mesh = solids.impeller(kind, hub=hub, thickness=thickness, facets=40)
            hubs = np.pi / 4 * hub**2 * 0.01
            shaft = np.pi / 4 * 0.01**2 * (0.1 - 0.005)
            blades = 6 * thickness * 0.01 * (0.0125 if kind == "rushton" else (0.05 - hub) / 2)
            disc = np.pi / 4 * (0.0375**2 - hub**2) * thickness - 6 * thickness**2 * 0.00625
            if kind == "pitched":  # as wide, lying
                hubs, shaft = hubs * np.sqrt(0.5), np.pi / 4 * 0.01**2 * (0.1 - 0.005 * np.sqrt(0.5))
            self.expect_closed(mesh, hubs + shaft + blades + (disc if kind == "rushton" else 0), 0.05)

    def test_tube(self):
        mesh = solids.tube(rows=4, side=30)
        wall = np.pi * (0.0072**2 - 0.0069**2) * 0.04
        hole = np.pi / 4 * 0.007 * 0.005 * (0.0072**2 - 0.0069**2) / (2 * 0.0072)
        self.expect_closed(mesh, wall - 16 * hole, 0.01)

    def test_stl_keeps_the_solid(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = solids.tube(rows=2)
            mesh.write_stl(Path(folder) / "tube.stl")
            back = _surfaces.read_stl(Path(folder) / "tube.stl")
        self.assertEqual(len(back.vertices), len(mesh.vertices))
        self.expect_closed(back, mesh.volume(), 1e-5)

    def test_terrain_is_closed_below(self):
        heights = "ncols 3\nnrows 2\nxllcorner 9\nyllcenter 20\ncellsize 2\n3 4 6\n1 2 3\n"
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "map.asc").write_text(heights)
            surface = _surfaces.read_heights(Path(folder, "map.asc"))
            surface.write_stl(Path(folder, "map.stl"))
            for name in ("map.asc", "map.stl"):
                with self.subTest(name=name):
                    floor = {"kind": "terrain", "file": name, "thickness": "50 cm"}
                    mesh = _surfaces.primitive(floor, Path(folder))
                    self.expect_closed(mesh, 0.5 * 4 * 2, 1e-6)
                    np.testing.assert_allclose(mesh.vertices.min(0), [10, 20, 0.5], atol=1e-6)
                    np.testing.assert_allclose(mesh.vertices.max(0), [14, 22, 6], atol=1e-6)

    def test_the_valley_of_the_debris_flow_is_that_of_its_script(self):
        case = ROOT / "cases/debris_barrier"
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, case / "make_valley.py", Path(folder, "valley.asc")], check=True)
            self.assertEqual(Path(folder, "valley.asc").read_text(), (case / "valley.asc").read_text())
        valley = _surfaces.read_heights(case / "valley.asc").vertices
        middle = valley[np.abs(valley[:, 1]) < 1e-9]
        self.assertAlmostEqual(np.interp(0.2, middle[:, 0], middle[:, 2]) - np.interp(0.6, middle[:, 0], middle[:, 2]),
                               0.4 * np.tan(np.radians(32)), delta=1e-3)

    def test_outlines(self):
        box = {"it": {"kind": "box", "min": [0, 0, 0], "max": [1, 2, 3]}}
        (mesh,) = _surfaces.surfaces("it", box, Path())
        self.expect_closed(mesh, 6, 1e-12)
        self.assertEqual(len(outlines.edges(mesh, 1)), 12)
        lines = outlines.cut(mesh, 1, 0.5)
        self.assertAlmostEqual(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum(), 8)
        turn = _surfaces.rotation([1, 2, 3], 0.4)
        found, shift = _surfaces.motion_between(mesh.vertices, mesh.vertices @ turn.T + [1, 2, 3])
        np.testing.assert_allclose(found, turn, atol=1e-12)
        np.testing.assert_allclose(shift, [1, 2, 3])


class Agitator(unittest.TestCase):
    def test_rolls_or_slides_as_it_sets_off(self):
        omega = 2 * np.pi * rolling.FREQUENCY
        ratio = rolling.INERTIA / (rolling.MASS * rolling.CAP**2)
        for friction, mass in ((0, 1), (1, 1 + ratio)):
            for t, angle, v in rolling.motion(friction, 0, 0.01):
                pass
            self.assertLess(angle, 0.01)
            self.assertAlmostEqual(v * mass / (rolling.AMPLITUDE * omega * (1 - np.cos(omega * t))), 1, delta=0.02)

    def test_resistance_to_rolling_takes_energy(self):
        slow, fast = (max(abs(v) for _, _, v in rolling.motion(0.3, couple, 1)) for couple in (0.13, 0))
        self.assertLess(slow, 0.7 * fast)

    def test_phases_of_a_swing(self):
        phase = np.linspace(0, 2, 2001)
        z = -np.cos(0.5 * np.cos(np.pi * (phase - 0.6)))
        found = phases.events(phase, z, np.zeros_like(z))
        half = np.arccos(np.arccos((1 + np.cos(0.5)) / 2) / 0.5) / np.pi
        for name, at in {"A": 0.6, "B": 0.6 + half, "C": 1.1, "D": 1.6 - half, "E": 1.6}.items():
            self.assertAlmostEqual(found[name][0], at, delta=0.002, msg=name)


class Bed(unittest.TestCase):
    def test_extents_with_and_without_a_lone_grain(self):
        drum = object.__new__(bed.Drum)
        drum.radius, drum.length = 0.05, 0.1
        drum.arrange()
        d = 2.5e-3
        x, y, z = (k.ravel() * d / 2 for k in np.meshgrid(np.arange(-16, 17), [0], np.arange(-30, -9)))
        places = np.append(np.transpose([x, y, z]), [[0.03, 0.0, 0.02]], axis=0)
        radius = np.full(len(places), d / 2)
        width, height = bed.extents(places, radius)
        self.assertAlmostEqual(width, 0.03 + 8 * d + d)
        self.assertAlmostEqual(height, 0.02 + 15 * d + d)
        width, height = drum.compact(drum.filled(places, radius), d)
        self.assertAlmostEqual(width, 17 * d, delta=2 * bed.CELL)
        self.assertAlmostEqual(height, 11 * d, delta=2 * bed.CELL)


if __name__ == "__main__":
    unittest.main()
