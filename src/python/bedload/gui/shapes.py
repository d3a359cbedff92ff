"""Surfaces of what a case describes, for the eye: shapes, boxes, openings, arrows."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Sequence

import numpy as np
import pyvista as pv

from .._surfaces import across, copies, placement, point, primitive, unit

FACETS = 72


def box(low: Sequence[Any], high: Sequence[Any]) -> pv.PolyData:
    (x0, y0, z0), (x1, y1, z1) = point(low), point(high)
    return pv.Box((x0, x1, y0, y1, z0, z1))


def surface(name: str, shapes: dict[str, dict], folder: Path) -> pv.PolyData:
    """The surface of a named shape; of a vessel, a union and a difference the surfaces of its parts."""
    shape = shapes[name]
    if "of" in shape:
        before = {key: value for key, value in shapes.items() if key != name}
        mesh = pv.merge([surface(part, before, folder) for part in shape["of"]], merge_points=False)
    else:
        mesh = _primitive(shape, folder)
    scale, turn, shift = placement(shape)
    placed = matrix(scale * turn, shift)
    placed = [mesh.transform(matrix(*copied) @ placed, inplace=False) for copied in copies(shape)]
    return placed[0] if len(placed) == 1 else pv.merge(placed, merge_points=False)


def _primitive(shape: dict, folder: Path) -> pv.PolyData:
    found = primitive(shape, folder)
    if found is not None:
        return pv.PolyData.from_regular_faces(found.vertices, found.triangles)
    path = Path(folder) / shape["file"]
    if not path.exists():
        raise ValueError(f"{path} is missing")
    return pv.read(path).extract_surface(algorithm="dataset_surface")


def filled(mesh: pv.PolyData, level: float, up: np.ndarray) -> pv.PolyData:
    """What lies below a level, counted along `up` from the origin."""
    try:
        return mesh.triangulate().clean().clip_closed_surface(normal=tuple(-up), origin=tuple(level * up))
    except (ValueError, RuntimeError):  # it is not closed
        return mesh.clip(normal=tuple(up), origin=tuple(level * up))


def plane(centre: np.ndarray, normal: Sequence[Any], size: float) -> pv.PolyData:
    return pv.Plane(center=tuple(centre), direction=tuple(map(float, normal)), i_size=size, j_size=size)


def disc(centre: np.ndarray, direction: Sequence[Any], radius: float) -> pv.PolyData:
    return pv.Disc(center=tuple(centre), inner=0, outer=radius, normal=tuple(map(float, direction)), c_res=FACETS)


def rectangle(centre: np.ndarray, a: np.ndarray, b: np.ndarray) -> pv.PolyData:
    return pv.PolyData(np.array([centre - a - b, centre + a - b, centre + a + b, centre - a + b]), [4, 0, 1, 2, 3])


def arrow(start: np.ndarray, direction: Sequence[Any], length: float) -> pv.PolyData:
    return pv.Arrow(start=tuple(start), direction=unit(direction), scale=length, shaft_radius=0.025,
                    tip_radius=0.07, tip_length=0.25)


def turning(centre: np.ndarray, axis: Sequence[Any], radius: float, length: float) -> pv.PolyData:
    """An axis and, about it, an arrow that follows the right hand."""
    axis = unit(axis)
    u, v = across(axis)
    angles = np.radians(np.linspace(0, 280, 120))[:, None]
    arc = centre + radius * (np.cos(angles) * u + np.sin(angles) * v)
    thick = 0.025 * radius
    tip = pv.Cone(center=tuple(arc[-1]), direction=tuple(arc[-1] - arc[-2]), height=0.3 * radius, radius=0.09 * radius,
                  resolution=24)
    ends = centre - axis * length / 2, centre + axis * length / 2
    rod = pv.Line(tuple(ends[0]), tuple(ends[1])).tube(radius=0.6 * thick, n_sides=18)
    return pv.merge([pv.MultipleLines(points=arc).tube(radius=thick, n_sides=18), rod, tip], merge_points=False)


def matrix(turn: np.ndarray, shift: np.ndarray) -> np.ndarray:
    """Turn and shift as one matrix, 4 x 4."""
    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = turn, shift
    return motion
