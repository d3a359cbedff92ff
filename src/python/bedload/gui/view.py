"""The picture: parts of a case and particles, drawn by VTK, with a camera, picking, pictures and films."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterable

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkPropPicker
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

from .._surfaces import motion_between
from . import shapes
from .run import Cloud
from .scene import FLUID, GRAIN, WALL, Part

NONE = "plain"
MAPS = {"fluid": "viridis", "grains": "plasma"}
COLOURS = {"fluid": FLUID, "grains": GRAIN, "walls": WALL}
SELECTED = "#ff7a1a"
DIRECTIONS = {"x": ((1, 0, 0), (0, 0, 1)), "y": ((0, -1, 0), (0, 0, 1)), "z": ((0, 0, 1), (0, 1, 0)),
              "3-D": ((0.55, -1.0, 0.45), (0, 0, 1))}


@dataclass
class Look:
    """How particles are shown."""

    colour: dict[str, str]  #: field by kind of particle, or NONE
    cut: str = ""  #: "x", "y", "z": what lies beyond `at` on that axis is left out
    at: float = 0.5  #: fraction of the box around everything
    hidden: tuple[str, ...] = ()  #: kinds that are not shown
    limits: dict[str, tuple[float, float]] | None = None  #: of the colours by kind; from the values by default


def values_of(cloud: Cloud, name: str) -> np.ndarray | None:
    """A number for each particle: a field, or the length of a vector."""
    array = cloud.fields.get(name)
    if array is None:
        return None
    return np.linalg.norm(array, axis=1) if array.ndim == 2 else array.astype(float)


class View:
    """A window without a display."""

    def __init__(self, size: tuple[int, int] = (900, 600)):
        pv.global_theme.font.family = "arial"
        self.plotter = pv.Plotter(off_screen=True, window_size=size, border=False)
        self.plotter.set_background("#f7f9fb", top="#dbe4ec")
        self.plotter.enable_anti_aliasing("msaa", multi_samples=4)
        self.plotter.add_axes(line_width=2, color="#44515c", viewport=(0, 0, 0.13, 0.18))
        self._paths: dict[Any, str] = {}  # of actors
        self._bounds: np.ndarray | None = None
        self._grabbed: float | None = None  # depth in the picture of what is dragged
        self._depth_of_picked, self._from = 0.0, np.zeros(3)

    def show(self, parts: Iterable[Part], selected: str = "", clouds: dict[str, Cloud] | None = None,
             look: Look | None = None, spacing: float = 0.0, time: float | None = None,
             moved: dict[str, np.ndarray | None] | None = None, outline: pv.PolyData | None = None) -> None:
        """Draws parts and particles anew. spacing: of fluid particles, m. moved: motions (4 x 4) of bodies by
        path; None: removed. outline: marked as selected as well."""
        for bar in list(self.plotter.scalar_bars.keys()):
            self.plotter.remove_scalar_bar(bar, render=False)
        for actor in self._paths:
            self.plotter.remove_actor(actor, render=False)
        self._paths = {}
        parts = list(parts)
        if self._bounds is None and parts:
            self.look_from("3-D", parts)
        for part in parts:
            motion = (moved or {}).get(part.path, np.eye(4))
            if motion is not None:
                self._add_part(part, bool(selected) and _within(part.path, selected), motion)
        if outline is not None:
            edges = outline.extract_feature_edges(30)
            self._add(edges if edges.n_points else outline.outline(), selected, color=SELECTED, line_width=3)
        for store, cloud in (clouds or {}).items():
            if look is not None and store not in look.hidden and store in ("fluid", "grains"):
                self._add_cloud(store, cloud, look, spacing, parts)
        words = "" if time is None else f"t = {time:.4g} s"
        self.plotter.add_text(words, position=(0.015, 0.945), viewport=True, font_size=8, color="#33404a", name="time",
                              render=False)

    def look_from(self, direction: str, parts: Iterable[Part] = ()) -> None:
        """Points the camera along an axis, or from above the left shoulder, at everything."""
        corners = [np.array(part.mesh.bounds).reshape(3, 2) for part in parts]
        if corners:
            domain = np.stack(corners)
            self._bounds = np.stack([domain[:, :, 0].min(axis=0), domain[:, :, 1].max(axis=0)], axis=1)
        way, up = DIRECTIONS[direction]
        bounds = None if self._bounds is None else tuple(self._bounds.ravel())
        self.plotter.view_vector(way, viewup=up, render=False, bounds=bounds)
        self.plotter.camera.zoom(0.97)

    @property
    def size(self) -> float:
        """Diagonal of everything, m."""
        return float(np.linalg.norm(self._bounds[:, 1] - self._bounds[:, 0])) if self._bounds is not None else 1.0

    def pick(self, x: float, y: float) -> str:
        """The path of what is at a place of the picture, in pixels from its lower left; empty if nothing is."""
        picker = vtkPropPicker()
        picker.PickProp(x, y, self.plotter.renderer)
        renderer = self.plotter.renderer
        renderer.SetWorldPoint(*picker.GetPickPosition(), 1.0)
        renderer.WorldToDisplay()
        self._depth_of_picked = renderer.GetDisplayPoint()[2]
        return self._paths.get(picker.GetActor(), "")

    def grab(self, x: float, y: float) -> str:
        """The path of what is at a place of the picture and is to be dragged from there."""
        path = self.pick(x, y)
        self._grabbed = self._depth_of_picked if path else None
        self._from = self._world(x, y) if path else np.zeros(3)
        return path

    def drag(self, x: float, y: float, path: str) -> np.ndarray:
        """Shows what has been grabbed where the pointer is; returns how far that is from where it was, m."""
        shift = self._world(x, y) - self._from
        for actor, own in self._paths.items():
            if _within(own, path):
                actor.SetPosition(*shift)
        return shift

    def _world(self, x: float, y: float) -> np.ndarray:
        """The point behind a place of the picture, as deep as what has been grabbed."""
        renderer = self.plotter.renderer
        renderer.SetDisplayPoint(x, y, self._grabbed)
        renderer.DisplayToWorld()
        point = np.array(renderer.GetWorldPoint())
        return point[:3] / point[3]

    def picture(self, scale: int = 1) -> np.ndarray:
        """What is seen, [height, width, 3]."""
        self.plotter.render()
        return np.ascontiguousarray(self.plotter.screenshot(return_img=True, scale=scale)[:, :, :3])

    def _add_part(self, part: Part, selected: bool, motion: np.ndarray) -> None:
        mesh = part.mesh.transform(motion, inplace=False)
        if part.lines:
            self._add(mesh, part.path, style="wireframe", color=SELECTED if selected else part.colour,
                      line_width=3 if selected else 1.2)
            return
        self._add(mesh, part.path, color=part.colour, opacity=part.opacity, specular=0.2, ambient=0.35,
                  diffuse=0.75, smooth_shading=part.opacity == 1, split_sharp_edges=True)
        edges = mesh.extract_feature_edges(30) if mesh.n_cells < 100_000 else mesh.outline()
        if edges.n_points and (selected or part.opacity < 1):
            self._add(edges, part.path, color=SELECTED if selected else part.colour, line_width=3 if selected else 1.2)

    def _add(self, mesh: pv.PolyData, path: str, **how: Any) -> None:
        actor = self.plotter.add_mesh(mesh, show_scalar_bar=False, reset_camera=False, render=False, scalars=None,
                                      **how)
        self._paths[actor] = path

    def _add_cloud(self, store: str, cloud: Cloud, look: Look, spacing: float, parts: list[Part]) -> None:
        seen = self._not_cut(cloud.position, look)
        points = pv.PolyData(np.asarray(cloud.position, np.float32)[seen])
        if not points.n_points:
            return
        radius = cloud.fields["radius"] if "radius" in cloud.fields else np.full(len(seen), 0.5 * spacing)
        points["radius"] = np.asarray(radius, np.float32)[seen]
        mapper = vtkOpenGLSphereMapper()
        mapper.SetInputData(points)
        mapper.SetScaleArray("radius")
        actor = vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*pv.Color(COLOURS[store]).float_rgb)
        actor.GetProperty().SetSpecular(0.25)
        actor.GetProperty().SetSpecularPower(20)
        name = look.colour.get(store, NONE)
        values = values_of(cloud, name)
        if values is not None:
            low, high = (look.limits or {}).get(store) or limits_of(values)
            table = pv.LookupTable(MAPS.get(store, "viridis"), scalar_range=(low, high))
            points["colour"] = values[seen]
            points.set_active_scalars("colour")
            mapper.SetLookupTable(table)
            mapper.SetScalarRange(low, high)
            mapper.SetScalarModeToUsePointFieldData()
            mapper.SelectColorArray("colour")
            self._add_scale(f"{store}: {name} [{cloud.units.get(name, '-')}]", table, store)
        else:
            mapper.ScalarVisibilityOff()
        self.plotter.add_actor(actor, reset_camera=False, render=False, name=f"cloud {store}")
        self._paths[actor] = f"{'grain' if store == 'grains' else store}"

    def _add_scale(self, title: str, table: Any, store: str) -> None:
        holder = pv.DataSetMapper()
        holder.lookup_table = table
        self.plotter.add_scalar_bar(title, mapper=holder, color="#33404a", title_font_size=14, label_font_size=12,
                                    n_labels=2, fmt="%.3g", width=0.32, height=0.06, render=False, n_colors=256,
                                    position_x=0.16 if store == "fluid" else 0.56, position_y=0.02)

    def _not_cut(self, position: np.ndarray, look: Look) -> np.ndarray:
        if not look.cut or self._bounds is None:
            return np.ones(len(position), bool)
        axis = "xyz".index(look.cut)
        low, high = self._bounds[axis]
        way = position[:, axis] if look.cut != "y" else -position[:, axis]
        limit = low + look.at * (high - low)
        return way <= limit if look.cut != "y" else way <= -(high - look.at * (high - low))


def limits_of(values: np.ndarray) -> tuple[float, float]:
    """Limits of colours without the outermost hundredth of the values."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return 0.0, 1.0
    low, high = np.percentile(finite, [0.5, 99.5])
    return (float(low), float(high)) if high > low else (float(low), float(low) + (abs(float(low)) or 1.0) * 1e-3)


def moved_bodies(case: dict[str, Any], before: Cloud | None, now: Cloud | None) -> dict[str, np.ndarray | None]:
    """How bodies have moved since the start, by path, from their wall particles then and now; None: removed."""
    if before is None or now is None or "body" not in now.fields:
        return {}
    found: dict[str, np.ndarray | None] = {}
    for number, _ in enumerate(case.get("wall", {}).get("body", [])):
        old, new = before.fields["body"] == number, now.fields["body"] == number
        if old.any() and not new.any():
            found[f"wall.body.{number}"] = None
        _, i, j = np.intersect1d(before.fields["id"][old], now.fields["id"][new], return_indices=True)
        if len(i) > 2:
            motion = motion_between(before.position[old][i].astype(float), now.position[new][j].astype(float))
            found[f"wall.body.{number}"] = shapes.matrix(*motion)
    return found


def write_film(path: str | Path, pictures: Iterable[np.ndarray], fps: float = 25) -> Iterable[int]:
    """Writes an .mp4 picture by picture; yields how many there are."""
    import imageio_ffmpeg

    writer = None
    try:
        for k, picture in enumerate(pictures):
            height, width = (2 * (n // 2) for n in picture.shape[:2])
            if writer is None:
                size = width, height
                writer = imageio_ffmpeg.write_frames(str(path), size, fps=fps, quality=7, macro_block_size=2)
                writer.send(None)
            writer.send(np.ascontiguousarray(picture[: size[1], : size[0]]))
            yield k + 1
    finally:
        if writer is not None:
            writer.close()


def _within(path: str, selected: str) -> bool:
    return f"{path}.".startswith(f"{selected}.")
