"""What a run folder holds to look at: frames of fluid and grains, and the walls as they stand at a time."""

from pathlib import Path

import numpy as np

import outlines
from frames import Frames, resolved_case


class Scene:
    """Frames and geometry of a run folder."""

    def __init__(self, folder):
        self.case = resolved_case(folder)
        stores = {name: Path(folder) / f"{name}.vtkhdf" for name in ("fluid", "grains")}
        self.frames = {name: Frames(path) for name, path in stores.items() if path.exists()}
        if not self.frames:
            raise SystemExit(f"{folder}: holds neither fluid.vtkhdf nor grains.vtkhdf")
        walls = Path(folder) / "walls.vtkhdf"
        self.walls = Frames(walls) if walls.exists() else None
        shapes = {shape["name"]: shape for shape in self.case.get("shape", [])}
        self.surfaces = {name: outlines.surfaces(name, shapes, Path(folder)) for name in shapes}
        self.dx = self.case.get("fluid", {}).get("dx") or self.estimated_spacing()

    def times(self):
        return next(iter(self.frames.values())).times

    def estimated_spacing(self):
        """Usual distance to the nearest particle of the first frame, m."""
        if "fluid" not in self.frames:
            return 0.0
        x = self.frames["fluid"].position(0)
        nearest = []
        for a in np.linspace(0, len(x) - 1, min(200, len(x)), dtype=int):
            r = np.linalg.norm(x - x[a], axis=1)
            r[a] = np.inf
            nearest.append(r.min())
        return float(np.median(nearest))

    def radii(self, frame):
        """Of the grains of a frame, m."""
        frames = self.frames["grains"]
        radius = frames.get(frame, "radius")
        if radius is None:
            diameter = frames.get(frame, "diameter")
            radius = diameter / 2 if diameter is not None else np.full(len(frames.position(frame)),
                                                                       self.case["grain"]["d"] / 2)
        return radius

    def bodies(self, time):
        """Wall bodies that are there at `time`, each with its turn and shift since the start: (body, R, s)."""
        for number, body in enumerate(self.case.get("wall", {}).get("body", [])):
            motion = body.get("motion", {})
            parts = [motion, *motion.get("add", [])]
            turn, shift = np.eye(3), sum((displacement(part, time) for part in parts), np.zeros(3))
            moves = "free" in body or any(part.get("kind", "fixed") != "fixed" for part in parts)
            if self.walls and moves:
                before, after = (self.particles_of(number, t) for t in (0, time))
                if len(after) != len(before):
                    continue
                if len(before) > 2:
                    turn, shift = outlines.motion_between(before, after)
            yield body, turn, shift

    def particles_of(self, body, time):
        """Places of a body's particles near `time`, in the order of their numbers."""
        frame = self.walls.nearest(time)
        own = np.flatnonzero(self.walls.get(frame, "body") == body)
        return self.walls.position(frame)[own[np.argsort(self.walls.get(frame, "id")[own])]]

    def boxes(self, time):
        """Tanks and boxes with corners as they stand at `time`: (body, min, max)."""
        for body, turn, shift in self.bodies(time):
            if body.get("shape") in ("tank", "box"):
                low, high = np.array(body["min"]), np.array(body["max"])
                moved = turn @ (low + high) / 2 + shift - (low + high) / 2
                yield body, low + moved, high + moved

    def meshes(self, time):
        """Surfaces of named shapes as they stand at `time`."""
        for body, turn, shift in self.bodies(time):
            for mesh in self.surfaces.get(body.get("shape"), []):
                yield outlines.Mesh(mesh.vertices @ turn.T + shift, mesh.triangles)


def displacement(motion, time):
    """How far a part of a motion has moved by `time`, m; turns and formulas show only where walls.vtkhdf does."""
    begin = motion.get("start", 0.0)
    t = min(max(time, begin), motion.get("stop", np.inf)) - begin
    if motion.get("kind") == "velocity":
        return np.array(motion["velocity"]) * t
    if motion.get("kind") == "oscillation":
        return np.array(motion["amplitude"]) * np.sin(2 * np.pi * motion["frequency"] * t)
    if motion.get("kind") == "table":
        rows = np.array([row[:4] for row in motion["rows"]])
        return np.array([np.interp(t, rows[:, 0], rows[:, k]) for k in (1, 2, 3)])
    return np.zeros(3)
