"""Reads the frames that vtkhdf_test.cpp wrote with VTK's own reader and compares
every point and array with the formulas of fake_simulation.hpp; the XDMF side-cars
must lead to the same numbers. Usage: read_vtkhdf.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

STEPS = [0, 4, 8, 12, 16]
DT = 0.03


def expected(store, step):
    """Points and arrays of one frame."""
    n = {"fluid": 7 if step < 10 else 6, "grains": 3, "walls": 4}[store]
    t = 0.0 if store == "walls" else step * DT
    i = np.arange(n, dtype=float)
    return {
        "position": np.stack([i + t, 2 * i, 0.125 - t * i], axis=1),
        "speed": 10 * i + t,
        "spin": np.stack([np.full(n, t), 1e-3 * i, np.full(n, -t)], axis=1),
        "id": 100 + i,
    }


def compare(what, found, wanted, tolerance):
    found = np.asarray(found, dtype=float)
    if found.shape != wanted.shape or not np.allclose(found, wanted, rtol=tolerance, atol=tolerance):
        raise SystemExit(f"{what}: read {found.tolist()}, expected {wanted.tolist()}")


def read_frame(reader, index, time):
    reader.SetStep(index)
    reader.Update()
    frame = reader.GetOutput()
    n = frame.GetNumberOfPoints()
    if frame.GetNumberOfVerts() != n or frame.GetNumberOfCells() != n:
        raise SystemExit(f"frame {index}: {frame.GetNumberOfCells()} cells for {n} points")
    verts = frame.GetVerts()
    if n and vtk_to_numpy(verts.GetConnectivityArray()).tolist() != list(range(n)):
        raise SystemExit(f"frame {index}: vertex cells do not number the points")
    if n and vtk_to_numpy(verts.GetOffsetsArray()).tolist() != list(range(n + 1)):
        raise SystemExit(f"frame {index}: vertex cells do not have one point each")
    if abs(reader.GetTimeValue() - time) > 1e-12:
        raise SystemExit(f"frame {index}: time {reader.GetTimeValue()}, expected {time}")
    data = frame.GetPointData()
    arrays = {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
    arrays["position"] = vtk_to_numpy(frame.GetPoints().GetData()) if n else np.zeros((0, 3))
    return arrays


def open_frames(path, count):
    reader = vtkHDFReader()
    if not reader.CanReadFile(str(path)):
        raise SystemExit(f"{path.name}: VTK does not know this file")
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    if reader.GetNumberOfSteps() != count:
        raise SystemExit(f"{path.name}: {reader.GetNumberOfSteps()} frames, expected {count}")
    return reader


def check_frames(path, store, order):
    """All frames of one file, visited in the given order."""
    reader = open_frames(path, len(STEPS))
    for k in order:
        frame, wanted = read_frame(reader, k, STEPS[k] * DT), expected(store, STEPS[k])
        if set(frame) - {"position"} != set(wanted) - {"position"}:
            raise SystemExit(f"{path.name}: arrays {sorted(frame)}, expected {sorted(wanted)}")
        for name, values in wanted.items():
            double = name == "spin" or (name == "position" and store == "grains")
            compare(f"{path.name} frame {k} {name}", frame[name], values, 1e-15 if double else 1e-6)


def check_xdmf(path, store):
    """All frames of a side-car, through VTK's reader of XDMF 2."""
    reader = vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    compare(f"{path.name} times", times, np.array(STEPS) * DT, 1e-12)
    for time, step in zip(times, STEPS):
        reader.UpdateTimeStep(time)
        frame, wanted = reader.GetOutputDataObject(0), expected(store, step)
        points = vtk_to_numpy(frame.GetPoints().GetData())
        compare(f"{path.name} points", points, wanted.pop("position"), 1e-6)
        data = frame.GetPointData()
        if data.GetNumberOfArrays() != len(wanted):
            raise SystemExit(f"{path.name}: {data.GetNumberOfArrays()} arrays, expected {len(wanted)}")
        for name, values in wanted.items():
            compare(f"{path.name} {name}", vtk_to_numpy(data.GetArray(name)), values, 1e-6)


def check_emptied(path):
    reader = open_frames(path, 3)
    for k, n in enumerate([4, 0, 4]):
        frame = read_frame(reader, k, float(k))
        if len(frame["position"]) != n:
            raise SystemExit(f"{path.name} frame {k}: {len(frame['position'])} points, expected {n}")


def check_nodes(path):
    """Images, by both readers: node_frames.hpp has the formulas."""
    n = np.arange(30, dtype=float)
    reader = open_frames(path, 3)
    xdmf = vtkXdmfReader()
    xdmf.SetFileName(str(path.with_suffix(".xdmf")))
    xdmf.UpdateInformation()
    for k in (0, 2, 1):
        reader.SetStep(k)
        reader.Update()
        xdmf.UpdateTimeStep(0.5 * k)
        for frame in (reader.GetOutput(), xdmf.GetOutputDataObject(0)):
            compare(f"{path.name} frame {k} extent", frame.GetDimensions(), np.array([5, 3, 2]), 0)
            compare("first node", frame.GetPoint(0), np.array([0.25, 0.5, -1]), 1e-12)
            compare("last node", frame.GetPoint(29), np.array([2.25, 1.5, -0.5]), 1e-12)
            data = frame.GetPointData()
            compare("speed", vtk_to_numpy(data.GetArray("speed")), 100 * k + n, 1e-6)
            compare("velocity", vtk_to_numpy(data.GetArray("velocity")), np.stack([0 * n + k, n, -n], axis=1), 1e-6)
            compare("solid", vtk_to_numpy(data.GetArray("solid")), n % 4 == 0, 0)


def check_lines(path):
    """Lines, by both readers: fake_simulation.hpp has the formulas."""
    reader = open_frames(path, 4)
    xdmf = vtkXdmfReader()
    xdmf.SetFileName(str(path.with_suffix(".xdmf")))
    xdmf.UpdateInformation()
    for k in (0, 2, 3, 1):
        n = np.arange([3, 0, 5, 5][k], dtype=float)
        reader.SetStep(k)
        reader.Update()
        xdmf.UpdateTimeStep(0.5 * k)
        for frame in (reader.GetOutput(), xdmf.GetOutputDataObject(0)):
            if frame.GetNumberOfCells() != len(n):
                raise SystemExit(f"{path.name} frame {k}: {frame.GetNumberOfCells()} lines, expected {len(n)}")
            if not len(n):
                continue
            for line in range(len(n)):
                ends = [frame.GetPoint(frame.GetCell(line).GetPointId(end)) for end in (0, 1)]
                compare(f"{path.name} frame {k} line", ends, np.array([[line, k, 0], [line, k, 1]]), 1e-6)
            data = frame.GetCellData()
            compare(f"{path.name} frame {k} force", vtk_to_numpy(data.GetArray("force")), 10 * k + n, 1e-6)
            compare(f"{path.name} frame {k} id", vtk_to_numpy(data.GetArray("id")), 7 + n, 0)


def main():
    folder = Path(sys.argv[1])
    for store in ("fluid", "grains", "walls"):
        path = folder / f"{store}.vtkhdf"
        check_frames(path, store, range(5))
        check_frames(path, store, [4, 0, 3, 1, 2])
        check_xdmf(path.with_suffix(".xdmf"), store)
    check_frames(folder / "restarted_fluid.vtkhdf", "fluid", range(5))
    check_xdmf(folder / "restarted_fluid.xdmf", "fluid")
    check_nodes(folder / "nodes.vtkhdf")
    check_lines(folder / "contacts.vtkhdf")
    check_emptied(folder / "emptied.vtkhdf")


if __name__ == "__main__":
    main()
