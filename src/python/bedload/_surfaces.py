"""The solids of a case as triangles, for whatever draws them: primitives, meshes, terrain, copies, rigid motions."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Sequence

import numpy as np

FACETS = 72
LENGTHS = {"m": 1.0, "dm": 0.1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "km": 1e3}
STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])  # binary, a triangle


class Mesh:
    """Vertices [n, 3], m, and triangles [m, 3] between them, counter-clockwise seen from outside."""

    def __init__(self, vertices, triangles):
        self.vertices, self.triangles = np.asarray(vertices, float), np.asarray(triangles, int)

    def corners(self):
        return self.vertices[self.triangles]

    def volume(self):
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        return float(np.sum(a * np.cross(b, c)) / 6)

    def normals(self):
        """Of the triangles, of unit length."""
        a, b, c = np.moveaxis(self.corners(), 1, 0)
        n = np.cross(b - a, c - a)
        return n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)

    def write_stl(self, path):
        """Binary STL. A vertex is rounded once, so that triangles still meet in it."""
        facets = np.zeros(len(self.triangles), STL)
        facets["normal"], facets["corners"] = self.normals(), self.corners()
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        with open(path, "wb") as file:
            file.write(b"Bedload, lengths in m".ljust(80) + np.uint32(len(facets)).astype("<u4").tobytes())
            file.write(facets.tobytes())


def read_stl(path):
    """The triangles of a binary or ASCII STL file; equal corners become one vertex."""
    data = Path(path).read_bytes()
    count = int.from_bytes(data[80:84], "little")
    if len(data) == 84 + 50 * count:
        corners = np.frombuffer(data, STL, offset=84)["corners"].astype(float).reshape(-1, 3)
    else:
        lines = (line.split() for line in data.decode().splitlines())
        corners = np.array([words[1:4] for words in lines if words[:1] == ["vertex"]], float)
    vertices, triangles = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, triangles.reshape(-1, 3))


def revolve(profile, facets):
    """A profile of (r, z), counter-clockwise, turned about the z axis. Points with r = 0 stay single."""
    r, z = np.asarray(profile, float).T
    angle = 2 * np.pi * np.arange(facets) / facets
    vertices, ring = [], []  # ring[k][j]: vertex of profile point k at angle j
    for radius, height in zip(r, z):
        count = 1 if radius == 0 else facets
        ring.append(len(vertices) + np.arange(facets) % count)
        vertices += [(radius * np.cos(a), radius * np.sin(a), height) for a in angle[:count]]
    quads = []
    for k, following in enumerate(np.roll(np.arange(len(r)), -1)):
        a, b = ring[k], ring[following]
        quads.append(np.stack([a, np.roll(a, -1), np.roll(b, -1), b], axis=1))
    return Mesh(vertices, halves(np.concatenate(quads)))


def halves(quads):
    """The triangles of quads, less those that have a vertex twice. The diagonal is the same from both sides."""
    diagonal = np.where((quads.min(axis=1) == quads[:, 0]) | (quads.min(axis=1) == quads[:, 2]), 0, 1)
    k = (diagonal[:, None] + np.arange(4)) % 4
    q = np.take_along_axis(quads, k, axis=1)
    triangles = np.concatenate([q[:, [0, 1, 2]], q[:, [0, 2, 3]]])
    a, b, c = triangles.T
    return triangles[(a != b) & (b != c) & (c != a)]


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


def degrees(value: Any) -> float:
    """An angle of a case file: a number, or "30 deg"."""
    return float(value.removesuffix("deg")) if isinstance(value, str) else float(value)


def surfaces(name: str, shapes: dict[str, dict], folder: Path) -> list[Mesh]:
    """Meshes that bound the shape `name`; of sums and vessels the parts that they are made of.

    shapes: the [[shape]] tables by their names; folder: where mesh files with relative names lie.
    """
    shape = shapes[name]
    if "of" in shape:
        before = {key: value for key, value in shapes.items() if key != name}
        found = [mesh for part in shape["of"] for mesh in surfaces(part, before, folder)]
    else:
        mesh = primitive(shape, folder)
        found = [mesh] if mesh else []
    scale, turned, shift = placement(shape)
    found = [Mesh(scale * mesh.vertices @ turned.T + shift, mesh.triangles) for mesh in found]
    return [Mesh(mesh.vertices @ turned.T + shift, mesh.triangles) for turned, shift in copies(shape) for mesh in found]


def placement(shape: dict) -> tuple[float, np.ndarray, np.ndarray]:
    """Scale, turn and shift of a shape: x becomes scale turn x + shift."""
    turned = rotation(shape.get("turn_axis", [0, 0, 1]), np.radians(degrees(shape.get("turn_angle", 0))))
    return float(shape.get("scale", 1)), turned, point(shape.get("translate", [0, 0, 0]))


def copies(shape: dict) -> list[tuple[np.ndarray, np.ndarray]]:
    """Turn and shift of each copy of a placed shape, the first among them."""
    given = shape.get("copies", {})
    count, about = int(given.get("count", 1)), np.array(given.get("about", [0, 0, 0]), float)
    centre, along = (point(given.get(key, [0, 0, 0])) for key in ("centre", "along"))
    angle = degrees(given.get("angle", 360 / count))
    found = []
    for k in range(count):
        turned = rotation(about, np.radians(k * angle)) if np.any(about) else np.eye(3)
        found.append((turned, centre - turned @ centre + k * along))
    return found


def primitive(shape: dict, folder: Path) -> Mesh | None:
    """Mesh of a shape that is made of no others, before it is placed and copied; None for a file that is not there, or
    neither STL nor a height map."""
    kind = shape["kind"]
    if kind in ("mesh", "terrain"):
        path = Path(folder) / shape["file"]
        read = {".stl": read_stl, ".asc": read_heights}.get(path.suffix.lower())
        mesh = read(path) if read and path.exists() else None
        return closed_below(mesh, metres(shape.get("thickness", 0))) if mesh and kind == "terrain" else mesh
    if kind == "box":
        low, high = point(shape["min"]), point(shape["max"])
        square = revolve([(0, 0), (np.sqrt(0.5), 0), (np.sqrt(0.5), 1), (0, 1)], 4)
        eighth = rotation([0, 0, 1], np.pi / 4)
        return Mesh((square.vertices @ eighth.T + [0.5, 0.5, 0]) * (high - low) + low, square.triangles)
    r = metres(shape.get("radius", 0))
    if kind == "sphere":
        return lathe([(r * np.cos(a), r * np.sin(a)) for a in _arc(-90, 90)], point(shape["centre"]), [0, 0, 1])
    a, b = point(shape["a"]), point(shape["b"])
    length = float(np.linalg.norm(b - a))
    if kind == "capsule":
        caps = [(r * np.cos(s), r * np.sin(s) + (length if s > 0 else 0)) for s in [*_arc(-90, -1), *_arc(1, 90)]]
        return lathe(caps, a, b - a)
    if kind == "pipe":
        t, ends = metres(shape.get("thickness", 0.1 * r)), shape.get("ends", "open")
        bottom = [(0, 0), (0, -t), (r + t, -t)] if ends in ("closed_a", "closed") else [(r + t, 0)]
        top = [(r + t, length)]
        if ends in ("closed_b", "closed"):
            top = [(r + t, length + t), (0, length + t), (0, length)]
        return lathe([(r, 0), *bottom, *top, (r, length)], a, b - a)
    radii = (metres(shape["radius_a"]), metres(shape["radius_b"])) if kind == "cone" else (r, r)
    return lathe([(0, 0), *((e, z) for e, z in zip(radii, (0, length)) if e > 0), (0, length)], a, b - a)


def read_heights(path: str | Path) -> Mesh:
    """The open surface through the heights of an ESRI ASCII grid, as the program makes it of the file."""
    words = Path(path).read_text().lower().split()
    first = next(k for k in range(0, len(words), 2) if not words[k][0].isalpha())  # behind the header
    header = {key: float(value) for key, value in zip(words[:first:2], words[1:first:2])}
    columns, rows = int(header["ncols"]), int(header["nrows"])
    dx, dy = (header.get(key, header.get("cellsize", 0)) for key in ("dx", "dy"))
    x = header.get("xllcenter", header.get("xllcorner", 0) + dx / 2) + dx * np.arange(columns)
    y = header.get("yllcenter", header.get("yllcorner", 0) + dy / 2) + dy * np.arange(rows)[::-1]
    heights = np.array(words[first:], float).reshape(rows, columns)
    k = np.arange(rows * columns).reshape(rows, columns)
    nw, ne, sw, se = (part.ravel() for part in (k[:-1, :-1], k[:-1, 1:], k[1:, :-1], k[1:, 1:]))
    triangles = np.concatenate([np.stack([sw, se, ne], axis=1), np.stack([sw, ne, nw], axis=1)])
    return Mesh(np.stack([*np.meshgrid(x, y), heights], axis=-1).reshape(-1, 3), triangles)


def closed_below(mesh: Mesh, thickness: float) -> Mesh:
    """The solid below an open surface, `thickness` (m) thick along the vertical; 0: down to a level."""
    up = mesh.triangles[:, [0, 2, 1]]
    up = np.where(mesh.normals()[:, 2:] > 0, mesh.triangles, up)
    n = len(mesh.vertices)
    a, b = np.concatenate([up[:, [k, (k + 1) % 3]] for k in range(3)]).T
    rim = ~np.isin(a * n + b, b * n + a)
    a, b = a[rim], b[rim]
    sides = halves(np.stack([b, a, a + n, b + n], axis=1))
    low = mesh.vertices - [0, 0, thickness]
    if thickness == 0:
        low[:, 2] = low[:, 2].min() - np.linalg.norm(np.ptp(low, axis=0)) / 50
    return Mesh(np.concatenate([mesh.vertices, low]), np.concatenate([up, up[:, ::-1] + n, sides]))


def lathe(profile: Sequence[tuple[float, float]], foot: np.ndarray, axis: Sequence[Any]) -> Mesh:
    """A profile of (r, z) turned about `axis`, z counted from `foot`."""
    profile = [(0.0 if r < 1e-12 else r, z) for r, z in profile]
    mesh = revolve(profile, FACETS)
    return Mesh(mesh.vertices @ np.stack([*across(axis), unit(axis)]) + foot, mesh.triangles)


def unit(vector: Sequence[Any]) -> np.ndarray:
    """A vector over its length."""
    vector = np.array(vector, float)
    length = np.linalg.norm(vector)
    if not length > 0:
        raise ValueError("a direction of length 0")
    return vector / length


def across(axis: Sequence[Any]) -> tuple[np.ndarray, np.ndarray]:
    """Two directions across an axis and each other, right-handed."""
    axis = unit(axis)
    u = unit(np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]))
    return u, np.cross(axis, u)


def rotation(axis: Sequence[Any], angle: float) -> np.ndarray:
    """Matrix of a right-handed turn about `axis` through the origin."""
    x, y, z = unit(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def motion_between(before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Turn and shift (R, s), after = before R^T + s, of a rigid body by least squares over its points [n, 3]."""
    middle, now = before.mean(axis=0), after.mean(axis=0)
    u, _, v = np.linalg.svd((before - middle).T @ (after - now))
    turn = v.T @ np.diag([1, 1, np.sign(np.linalg.det(v.T @ u.T))]) @ u.T
    return turn, now - middle @ turn.T


def _arc(first: float, last: float) -> np.ndarray:
    return np.radians(np.linspace(first, last, FACETS // 4))
