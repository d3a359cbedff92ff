"""What a run folder holds to look at: frames of fluid and grains, and the walls as they stand at a time."""

from pathlib import Path

import numpy as np

from frames import Frames, Table, resolved_case
from bedload import _surfaces  # after frames, which finds it


class Scene:
    """Frames and geometry of a run folder."""

    def __init__(self, folder):
        self.case = resolved_case(folder)
        stores = {name: Path(folder) / f"{name}.vtkhdf" for name in ("fluid", "grains")}
        self.frames = {name: Frames(path) for name, path in stores.items() if path.exists()}
        if not self.frames:
            raise SystemExit(f"{folder}: has neither fluid.vtkhdf nor grains.vtkhdf")
        walls = Path(folder) / "walls.vtkhdf"
        self.walls = Frames(walls) if walls.exists() else None
        self.folder = Path(folder)
        self.shapes = {shape["name"]: shape for shape in self.case.get("shape", [])}
        self.surfaces = {name: _surfaces.surfaces(name, self.shapes, self.folder) for name in self.shapes}
        self.tables = {}
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
            pose = self.pose(number, body, time) if moves(body) else (np.eye(3), np.zeros(3))
            if pose is not None:
                yield body, *pose

    def pose(self, number, body, time):
        """Turn and shift of a body that moves: by its table, else by its particles or its motion; None when it has been
        removed."""
        if (table := self.table_of(body)) is not None:
            row = int(np.argmin(np.abs(table[table.header[0]] - time)))
            if "present [-]" in table.header and table["present"][row] == 0:
                return None
            turn = turn_of([table[f"rotation_{k}"][row] for k in "wxyz"])
            centre, now = (np.array([table[f"centre_{k}"][n] for k in "xyz"]) for n in (0, row))
            centre = centre if "free" in body else turning_centre(body["motion"])
            return turn, now - turn @ centre
        if self.walls:
            before, after = (self.particles_of(number, t) for t in (0, time))
            if len(after) != len(before):
                return None
            if len(before) > 2:
                return _surfaces.motion_between(before, after)
        return np.eye(3), sum((displacement(part, time) for part in parts_of(body)), np.zeros(3))

    def table_of(self, body):
        """What bodies/*.csv has of a body; None if it has nothing."""
        name = body["name"]
        if name not in self.tables:
            path = self.folder / "bodies" / f"{name}.csv"
            self.tables[name] = Table(path) if path.exists() else None
        return self.tables[name] if self.tables[name] else None

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
                yield _surfaces.Mesh(mesh.vertices @ turn.T + shift, mesh.triangles)


def parts_of(body):
    motion = body.get("motion", {})
    return [motion, *motion.get("add", [])]


def moves(body):
    return "free" in body or any(part.get("kind", "fixed") != "fixed" for part in parts_of(body))


def turn_of(quaternion):
    """Matrix of a unit quaternion (w, x, y, z)."""
    w, axis = quaternion[0], np.array(quaternion[1:])
    sine = np.linalg.norm(axis)
    return _surfaces.rotation(axis, 2 * np.arctan2(sine, w)) if sine > 0 else np.eye(3)


def turning_centre(motion):
    """The reference point of a body in its tables, at rest: the centre of the first part that rotates."""
    def turns(part):
        return part.get("kind") == "rotation" or any(text not in ("0", 0) for text in part.get("rotation", [])) or \
            any(np.any(row[4:]) for row in part.get("rows", []))

    first = next((part for part in [motion, *motion.get("add", [])] if turns(part)), motion)
    return np.array(first.get("centre", [0, 0, 0]), float)


def displacement(motion, time):
    """How far a part of a motion has moved by `time`, m; turns and formulas show only where tables or walls.vtkhdf
    do."""
    begin = motion.get("start", 0.0)
    t = min(max(time, begin), motion.get("stop", np.inf)) - begin
    if motion.get("kind") == "velocity" and motion.get("factor", "1") == "1":
        return np.array(motion["velocity"]) * t
    if motion.get("kind") == "oscillation":
        return np.array(motion["amplitude"]) * np.sin(2 * np.pi * motion["frequency"] * t)
    if motion.get("kind") == "table":
        rows = np.array([row[:4] for row in motion["rows"]])
        return np.array([np.interp(t, rows[:, 0], rows[:, k]) for k in (1, 2, 3)])
    return np.zeros(3)
