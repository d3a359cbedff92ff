"""Surfaces of what a case describes, for the eye: shapes, boxes, openings, arrows."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Sequence

import numpy as np
import pyvista as pv

FACETS = 72
LENGTHS = {"m": 1.0, "dm": 0.1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "km": 1e3}


def metres(value: Any) -> float:
    """A length of a case file: a number, or "2 mm"."""
    if not isinstance(value, str):
        return float(value)
    number, unit = re.fullmatch(r"\s*([-+.\deE]+?)\s*([A-Za-zµ]*)\s*", value).groups()
    return float(number) * LENGTHS[unit or "m"]


def point(values: Sequence[Any]) -> np.ndarray:
    """Three lengths."""
    x, y, z = map(metres, values)
    return np.array([x, y, z])


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
    scale, axis = float(shape.get("scale", 1)), shape.get("turn_axis", [0, 0, 1])
    placed = np.eye(4)
    placed[:3, :3] = scale * rotation(axis, np.radians(_degrees(shape.get("turn_angle", 0))))
    placed[:3, 3] = point(shape.get("translate", [0, 0, 0]))
    placed = [mesh.transform(copied @ placed, inplace=False) for copied in _copies(shape.get("copies", {}))]
    return placed[0] if len(placed) == 1 else pv.merge(placed, merge_points=False)


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
    return pv.Arrow(start=tuple(start), direction=_unit(direction), scale=length, shaft_radius=0.025,
                    tip_radius=0.07, tip_length=0.25)


def turning(centre: np.ndarray, axis: Sequence[Any], radius: float, length: float) -> pv.PolyData:
    """An axis and, about it, an arrow that follows the right hand."""
    axis = _unit(axis)
    u, v = _across(axis)
    angles = np.radians(np.linspace(0, 280, 120))[:, None]
    arc = centre + radius * (np.cos(angles) * u + np.sin(angles) * v)
    thick = 0.025 * radius
    tip = pv.Cone(center=tuple(arc[-1]), direction=tuple(arc[-1] - arc[-2]), height=0.3 * radius, radius=0.09 * radius,
                  resolution=24)
    ends = centre - axis * length / 2, centre + axis * length / 2
    rod = pv.Line(tuple(ends[0]), tuple(ends[1])).tube(radius=0.6 * thick, n_sides=18)
    return pv.merge([pv.MultipleLines(points=arc).tube(radius=thick, n_sides=18), rod, tip], merge_points=False)


def rotation(axis: Sequence[Any], angle: float) -> np.ndarray:
    """Matrix of a right-handed rotation about an axis through the origin."""
    x, y, z = _unit(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def motion_between(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """The rigid motion (4 x 4) that takes the points `before` [n, 3] closest to `after`, by least squares."""
    middle, now = before.mean(axis=0), after.mean(axis=0)
    u, _, v = np.linalg.svd((before - middle).T @ (after - now))
    turn = v.T @ np.diag([1, 1, np.sign(np.linalg.det(v.T @ u.T))]) @ u.T
    motion = np.eye(4)
    motion[:3, :3], motion[:3, 3] = turn, now - turn @ middle
    return motion


def _primitive(shape: dict, folder: Path) -> pv.PolyData:
    kind = shape["kind"]
    if kind == "box":
        return box(shape["min"], shape["max"])
    if kind == "mesh":
        path = Path(folder) / shape["file"]
        if not path.exists():
            raise ValueError(f"{path} is missing")
        return pv.read(path).extract_surface(algorithm="dataset_surface")
    if kind == "sphere":
        return pv.Sphere(radius=metres(shape["radius"]), center=tuple(point(shape["centre"])), theta_resolution=48,
                         phi_resolution=48)
    a, b = point(shape["a"]), point(shape["b"])
    length = float(np.linalg.norm(b - a))
    if kind == "cone":
        return _lathe([(0, 0), (metres(shape["radius_a"]), 0), (metres(shape["radius_b"]), length), (0, length)], a, b)
    r = metres(shape["radius"])
    if kind == "capsule":
        half = np.radians(np.linspace(0, 90, 12))
        low = [(r * np.cos(s), -r * np.sin(s)) for s in half[::-1]]
        high = [(r * np.cos(s), length + r * np.sin(s)) for s in half]
        return _lathe([*low, *high], a, b)
    if kind == "pipe":
        t, ends = metres(shape.get("thickness", 0.1 * r)), shape.get("ends", "open")
        low = [(0, 0), (0, -t), (r + t, -t)] if ends in ("closed_a", "closed") else [(r + t, 0)]
        high = [(r + t, length)]
        if ends in ("closed_b", "closed"):
            high = [(r + t, length + t), (0, length + t), (0, length)]
        return _lathe([(r, 0), *low, *high, (r, length), (r, 0)], a, b)
    return _lathe([(0, 0), (r, 0), (r, length), (0, length)], a, b)


def _lathe(profile: Sequence[tuple[float, float]], a: np.ndarray, b: np.ndarray) -> pv.PolyData:
    """A profile of (r, z) turned about the axis from a to b, z counted from a."""
    axis = _unit(b - a)
    u, v = _across(axis)
    angle = np.linspace(0, 2 * np.pi, FACETS, endpoint=False)
    round_ = np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
    points = np.concatenate([a + r * round_ + z * axis for r, z in profile])
    k, n = np.meshgrid(np.arange(len(profile) - 1), np.arange(FACETS), indexing="ij")
    here, after = k * FACETS + n, k * FACETS + (n + 1) % FACETS
    quads = np.stack([here, after, after + FACETS, here + FACETS], axis=-1).reshape(-1, 4)
    return pv.PolyData.from_regular_faces(points, quads).clean()


def _copies(given: dict) -> list[np.ndarray]:
    """The motion (4 x 4) of each copy of a shape, the first included."""
    count, about = int(given.get("count", 1)), given.get("about", [0, 0, 0])
    centre, along = point(given.get("centre", [0, 0, 0])), point(given.get("along", [0, 0, 0]))
    angle = np.radians(_degrees(given.get("angle", 360 / count)))
    found = []
    for k in range(count):
        motion = np.eye(4)
        motion[:3, :3] = rotation(about, k * angle) if np.any(np.array(about, float)) else np.eye(3)
        motion[:3, 3] = centre - motion[:3, :3] @ centre + k * along
        found.append(motion)
    return found


def _degrees(value: Any) -> float:
    return float(value.removesuffix("deg")) if isinstance(value, str) else float(value)


def _unit(vector: Sequence[Any]) -> np.ndarray:
    vector = np.array(vector, float)
    length = np.linalg.norm(vector)
    if not length > 0:
        raise ValueError("a direction of length 0")
    return vector / length


def _across(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two directions across an axis and each other, right-handed."""
    u = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    u /= np.linalg.norm(u)
    return u, np.cross(axis, u)
