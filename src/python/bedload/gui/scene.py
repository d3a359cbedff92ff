"""What is seen of a case: domain, walls, fills, openings, probes, motions, each with the path of its table."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterator

import numpy as np
import pyvista as pv

from .._surfaces import metres, point
from . import shapes

WALL, FLUID, GRAIN, INLET, OUTLET, PROBE, MOTION, FRAME = (
    "#8796a5", "#2f86c1", "#c98b45", "#2e9e6b", "#c94f4f", "#8657b5", "#4a55b8", "#5d6b78")


@dataclass
class Part:
    """Something to draw."""

    path: str  #: of its table
    mesh: pv.PolyData
    colour: str
    opacity: float = 1.0
    lines: bool = False  #: its edges alone


def parts_of(case: dict[str, Any], folder: str | Path = ".") -> list[Part]:
    """The parts of a case that can be drawn. case: resolved, or as given while it has an error: what is not complete
    yet is left out. folder: of the case file."""
    found: list[Part] = []
    scene = _Scene(case, Path(folder))
    for drawn in (scene.domain, scene.walls, scene.fluid, scene.grains, scene.inlets, scene.outlets, scene.probes,
                  scene.lone_shapes):
        found += drawn()
    return found


class _Scene:
    def __init__(self, case: dict[str, Any], folder: Path):
        self.case, self.folder = case, folder
        self.shapes = {shape.get("name", ""): shape for shape in _tables(case, "shape")}
        domain = case.get("domain", {})
        try:
            self.low, self.high = point(domain["min"]), point(domain["max"])
        except (KeyError, TypeError, ValueError, AttributeError):
            self.low, self.high = np.zeros(3), np.zeros(3)
        self.size = float(np.linalg.norm(self.high - self.low)) or 1.0
        self.middle = (self.low + self.high) / 2

    def domain(self) -> Iterator[Part]:
        if np.all(self.high > self.low):
            yield Part("domain", shapes.box(self.low, self.high), FRAME, lines=True)

    def walls(self) -> Iterator[Part]:
        for k, body in enumerate(_tables(self.case, "wall", "body")):
            path = f"wall.body.{k}"
            mesh = _drawn(lambda: self.body(body))
            if mesh is None:
                continue
            yield Part(path, mesh, WALL, 0.22)
            motion = _drawn(lambda: self.motion(body.get("motion", {}), mesh))
            if motion is not None:
                yield Part(f"{path}.motion", motion, MOTION)

    def body(self, body: dict) -> pv.PolyData:
        if body["shape"] == "box":
            return shapes.box(body["min"], body["max"])
        if body["shape"] == "tank":
            mesh = shapes.box(body["min"], body["max"])
            names = ["x-", "x+", "y-", "y+", "z-", "z+"]
            faces = body.get("faces", names)
            sides = mesh.extract_cells([names.index(face) for face in faces])
            return sides.extract_surface(algorithm="dataset_surface")
        if body["shape"] == "plane":
            return shapes.plane(point(body["point"]), body["normal"], self.size)
        return shapes.surface(body["shape"], self.shapes, self.folder)

    def motion(self, motion: dict, mesh: pv.PolyData) -> pv.PolyData | None:
        kind, middle = motion.get("kind"), np.array(mesh.center)
        if kind == "rotation":
            axis, centre = motion["axis"], point(motion.get("centre", [0, 0, 0]))
            return shapes.turning(centre, axis, 0.3 * mesh.length, 0.9 * mesh.length)
        if kind == "velocity":
            return shapes.arrow(middle, motion["velocity"], 0.5 * mesh.length)
        if kind == "oscillation":
            there = np.array(motion["amplitude"], float)
            return pv.merge([shapes.arrow(middle, way * there, 0.4 * mesh.length) for way in (1, -1)],
                            merge_points=False)
        return None

    def fluid(self) -> Iterator[Part]:
        for k, fill in enumerate(_tables(self.case, "fluid", "fill")):
            yield from _part(f"fluid.fill.{k}", lambda: self.fill(fill), FLUID, 0.45)

    def grains(self) -> Iterator[Part]:
        for k, fill in enumerate(_tables(self.case, "grain", "fill")):
            yield from _part(f"grain.fill.{k}", lambda: self.fill(fill), GRAIN, 0.3)

    def fill(self, fill: dict) -> pv.PolyData | None:
        if "file" in fill:
            return None
        if "positions" in fill:
            return pv.PolyData(np.array([point(x) for x in fill["positions"]])).glyph(
                geom=pv.Sphere(radius=self.size / 60), scale=False, orient=False)
        if "shape" not in fill:
            return shapes.box(fill["min"], fill["max"])
        mesh = shapes.surface(fill["shape"], self.shapes, self.folder)
        if "level" not in fill:
            return mesh
        gravity = np.array(self.case.get("gravity", [0, 0, -9.81]), float)
        strength = np.linalg.norm(gravity)
        return shapes.filled(mesh, metres(fill["level"]), -gravity / strength) if strength > 0 else mesh

    def inlets(self) -> Iterator[Part]:
        for k, inlet in enumerate(_tables(self.case, "inlet")):
            yield from _part(f"inlet.{k}", lambda: self.inlet(inlet), INLET, 0.9)
        for k, inlet in enumerate(_tables(self.case, "grain_inlet")):
            yield from _part(f"grain_inlet.{k}", lambda: self.inlet(inlet), GRAIN, 0.6)

    def inlet(self, inlet: dict) -> pv.PolyData:
        if "min" in inlet:
            return shapes.box(inlet["min"], inlet["max"])
        centre, way = point(inlet["centre"]), inlet["direction"]
        if "half_a" in inlet:
            opening = shapes.rectangle(centre, point(inlet["half_a"]), point(inlet["half_b"]))
        else:
            opening = shapes.disc(centre, way, metres(inlet["radius"]))
        return pv.merge([opening, shapes.arrow(centre, way, max(opening.length, self.size / 20))], merge_points=False)

    def outlets(self) -> Iterator[Part]:
        for k, outlet in enumerate(_tables(self.case, "outlet")):
            yield from _part(f"outlet.{k}", lambda: self.outlet(outlet), OUTLET, 0.35)

    def outlet(self, outlet: dict) -> pv.PolyData:
        if outlet.get("shape", "box") == "box":
            return shapes.box(outlet["min"], outlet["max"])
        if outlet["shape"] == "plane":
            return shapes.plane(point(outlet["point"]), outlet["normal"], self.size / 2)
        return shapes.surface(outlet["shape"], self.shapes, self.folder)

    def probes(self) -> Iterator[Part]:
        for k, probe in enumerate(_tables(self.case, "probe")):
            lines = probe.get("type") == "box"
            for part in _part(f"probe.{k}", lambda: self.probe(probe), PROBE, 1.0):
                part.lines = lines
                yield part

    def probe(self, probe: dict) -> pv.PolyData | None:
        if probe["type"] == "box":
            return shapes.box(probe["min"], probe["max"])
        if probe["type"] == "front":
            way = np.zeros(3)
            way["xyz".index(probe["direction"][0])] = 1 if probe["direction"][1] == "+" else -1
            return shapes.arrow(self.middle + way * 0.5 * np.abs(way @ (self.high - self.low)), way, self.size / 12)
        if "at" not in probe:
            return None
        at = point(probe["at"])
        mark = pv.Sphere(radius=self.size / 90, center=tuple(at))
        if probe["type"] != "height":
            return mark
        gauge = pv.Line((at[0], at[1], self.low[2]), (at[0], at[1], self.high[2])).tube(radius=self.size / 400)
        return pv.merge([mark, gauge], merge_points=False)

    def lone_shapes(self) -> Iterator[Part]:
        """Shapes that nothing uses yet."""
        lists = (("wall", "body"), ("fluid", "fill"), ("grain", "fill"), ("outlet",))
        users = [user for keys in lists for user in _tables(self.case, *keys)]
        used = {str(user.get("shape")) for user in users}
        used |= {part for shape in self.shapes.values() for part in _list(shape.get("of"))}
        for k, shape in enumerate(_tables(self.case, "shape")):
            if shape.get("name") not in used:
                named = shape.get("name")
                yield from _part(f"shape.{k}", lambda: shapes.surface(named, self.shapes, self.folder), WALL, 0.5)


def shape_outline(case: dict[str, Any], path: str, folder: str | Path) -> pv.PolyData | None:
    """The surface of the shape whose table is `path`, to show which one is edited."""
    tables = _tables(case, "shape")
    named = {shape.get("name", ""): shape for shape in tables}
    number = path.split(".")[1] if path.startswith("shape.") else ""
    if not number or int(number) >= len(tables):
        return None
    return _drawn(lambda: shapes.surface(tables[int(number)]["name"], named, Path(folder)))


def _part(path: str, make: Callable[[], pv.PolyData | None], colour: str, opacity: float) -> Iterator[Part]:
    mesh = _drawn(make)
    if mesh is not None and mesh.n_points:
        yield Part(path, mesh, colour, opacity)


def _drawn(make: Callable[[], Any]) -> Any:
    """What `make` returns; None while values are missing or wrong, which the form says beside the field."""
    try:
        return make()
    except (KeyError, TypeError, ValueError, IndexError, AttributeError):
        return None


def _tables(tree: Any, *keys: str) -> list[dict]:
    for key in keys:
        tree = tree.get(key) if isinstance(tree, dict) else None
    return [table for table in tree if isinstance(table, dict)] if isinstance(tree, list) else []


def _list(value: Any) -> list[str]:
    return [part for part in value if isinstance(part, str)] if isinstance(value, list) else []
