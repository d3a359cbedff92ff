"""Moves what a table describes: a wall, a fill, an opening, a probe, a shape."""

from __future__ import annotations

import math

import numpy as np

from .._surfaces import metres
from .document import Document, bare

POINTS = {"shape": ("min", "max", "centre", "a", "b"), "wall.body": ("min", "max", "point"),
          "wall.body.motion": ("centre",), "fluid.fill": ("min", "max"), "grain.fill": ("min", "max"),
          "inlet": ("centre",), "grain_inlet": ("min", "max", "centre"), "outlet": ("min", "max", "point"),
          "probe": ("min", "max", "at")}  # keys that say where a table's thing is


def owner(document: Document, path: str) -> str:
    """The table whose keys say where something is: that of the shape of a wall or fill, if it has one; empty if it
    cannot be moved."""
    if bare(path) not in POINTS:
        return ""
    shapes = document.get("shape", [])
    names = {shape.get("name"): f"shape.{k}" for k, shape in enumerate(shapes)}
    table = document.get(path) or {}
    if bare(path) != "shape" and table.get("shape") in names:
        path = names[table["shape"]]
        table = document.get(path)
    if table.get("kind") == "hollow" and table.get("of") and table["of"][0] in names:
        return names[table["of"][0]]
    return path if _keys(document, path) else ""


def move(document: Document, path: str, shift: np.ndarray, grid: float) -> None:
    """Moves something by `shift`, m, to points of a grid of spacing `grid`, m. One step of the history."""
    path = owner(document, path)
    if not path:
        return
    work = Document(document.text)
    for key in _keys(document, path):
        old = np.array([metres(x) for x in document.get(f"{path}.{key}", [0, 0, 0])])
        new = np.where(np.abs(shift) >= grid / 2, np.round((old + shift) / grid) * grid, old)
        work.set(f"{path}.{key}", "[" + ", ".join(f"{x:.6g}" for x in new + 0.0) + "]")
    document.set_text(work.text)


def grid_of(size: float) -> float:
    """A round spacing, a few hundred to the size of a domain."""
    return 10.0 ** math.floor(math.log10(size / 100))


def _keys(document: Document, path: str) -> list[str]:
    """The points of a table. A shape that is a mesh, of others, or turned or scaled is moved by `translate`."""
    table = document.get(path) or {}
    if bare(path) == "shape" and ({"turn_angle", "scale"} & set(table) or "of" in table or "file" in table):
        return ["translate"]
    return [key for key in POINTS[bare(path)] if isinstance(table.get(key), list)]
