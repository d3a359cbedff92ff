"""Named shapes of a case as solids to draw: their surfaces, of unions and differences without what lies within, and
their sections."""

import numpy as np
import pyvista

import frames  # noqa: F401 (it finds the package)
from bedload import _surfaces

VESSELS = ("hollow", "pipe", "difference")  # kinds that hold fluid rather than move in it
FINE = 60  # edges along the diagonal of a surface that others cut
SECTION = 300  # cells along the diagonal of a section


class Solid:
    """A closed surface; `vessel`: whether it holds fluid, whatever the body does."""

    def __init__(self, mesh, vessel=False):
        self.mesh, self.vessel = mesh.clean(), vessel

    def bounds(self):
        """Lower and upper corner, m."""
        return self.mesh.points.min(0), self.mesh.points.max(0)

    def distance(self, x):
        """Of places [n, 3] to the surface, m; negative inside."""
        return pyvista.PolyData(np.array(x, float)).compute_implicit_distance(self.mesh)["implicit_distance"]

    def pieces(self):
        """What is to be drawn: (surface, vessel)."""
        return [(self.mesh.copy(), self.vessel)]


class Hollow(Solid):
    """Vessel around a solid; its inside is drawn."""

    def __init__(self, solid, thickness):
        self.solid, self.thickness = solid, thickness

    def bounds(self):
        low, high = self.solid.bounds()
        return low - self.thickness, high + self.thickness

    def distance(self, x):
        d = self.solid.distance(x)
        return np.maximum(-d, d - self.thickness)

    def pieces(self):
        return [(mesh, True) for mesh, _ in self.solid.pieces()]


class Union(Solid):
    def __init__(self, parts):
        self.parts = parts

    def bounds(self):
        low, high = np.transpose([part.bounds() for part in self.parts], (1, 0, 2))
        return low.min(0), high.max(0)

    def distance(self, x):
        return np.min([part.distance(x) for part in self.parts], axis=0)

    def pieces(self):
        found = []
        for k, part in enumerate(self.parts):
            for mesh, vessel in part.pieces():
                # of surfaces that coincide the first is kept
                near = [(other, 1 if n < k else -1)
                        for n, other in enumerate(self.parts) if n != k and meet(mesh, other)]
                found.append((outside(mesh, near), vessel))
        return found


class Rest(Solid):
    """All that is outside a solid."""

    def __init__(self, solid):
        self.solid = solid

    def distance(self, x):
        return -self.solid.distance(x)


class Difference(Solid):
    """The first solid without the others."""

    def __init__(self, first, others):
        self.first, self.others = first, Union(others)

    def bounds(self):
        return self.first.bounds()

    def distance(self, x):
        return np.maximum(self.first.distance(x), -self.others.distance(x))

    def pieces(self):
        outer = [outside(mesh, [(self.others, 1)]) for mesh, _ in self.first.pieces()]
        inner = [outside(mesh, [(Rest(self.first), 1)]) for mesh, _ in self.others.pieces()]
        return [(mesh, True) for mesh in outer + inner]


class Placed(Solid):
    """A solid after x -> scale turn x + shift."""

    def __init__(self, solid, scale, turn, shift):
        self.solid, self.scale, self.turn, self.shift = solid, scale, turn, np.array(shift, float)

    def place(self, x):
        return self.scale * x @ self.turn.T + self.shift

    def bounds(self):
        corners = self.place(np.array(np.meshgrid(*np.transpose(self.solid.bounds()))).reshape(3, -1).T)
        return corners.min(0), corners.max(0)

    def distance(self, x):
        return self.scale * self.solid.distance((x - self.shift) @ self.turn / self.scale)

    def pieces(self):
        found = self.solid.pieces()
        for mesh, _ in found:
            mesh.points = self.place(mesh.points)
        return found


def solid(name, shapes, folder):
    """The solid that a [[shape]] stands for; None where a part of it is a mesh that is not to be read.

    shapes: the [[shape]] tables by their names; folder: where mesh files with relative names lie.
    """
    shape = shapes[name]
    if "of" in shape:
        parts = [solid(part, shapes, folder) for part in shape["of"]]
        if None in parts:
            return None
        if shape["kind"] == "hollow":
            made = Hollow(parts[0], shape.get("thickness", 0.0))
        else:
            made = Union(parts) if shape["kind"] == "union" else Difference(parts[0], parts[1:])
    else:
        mesh = _surfaces.primitive(shape, folder)
        if mesh is None:
            return None
        made = Solid(polydata(mesh.vertices, mesh.triangles), shape["kind"] in VESSELS)
    scale, turn, shift = _surfaces.placement(shape)
    if scale != 1 or np.any(turn != np.eye(3)) or np.any(shift != 0):
        made = Placed(made, scale, turn, shift)
    copies = _surfaces.copies(shape)
    return Union([Placed(made, 1.0, *copy) for copy in copies]) if len(copies) > 1 else made


def meet(mesh, solid):
    """Whether the boxes about them overlap."""
    low, high = solid.bounds()
    return mesh.n_points and np.all(mesh.points.min(0) <= high) and np.all(mesh.points.max(0) >= low)


def outside(mesh, solids):
    """The part of a surface that lies in none of `solids` [(solid, side)]; of what lies on their surface that with side
    -1."""
    if not solids or not mesh.n_points:
        return mesh
    size = np.linalg.norm(np.ptp(mesh.points, axis=0))
    fine = mesh.triangulate().subdivide_adaptive(max_edge_len=size / FINE, max_n_passes=12)
    d = np.min([solid.distance(fine.points) - side * 1e-5 * size for solid, side in solids], axis=0)
    if d.min() > 0:
        return mesh
    fine["distance"] = d
    cut = fine.clip_scalar(scalars="distance", invert=False, value=0.0)
    cut.clear_data()
    return cut


def section(solid, axis, place, turn, shift):
    """The cut of a solid that stands turned and shifted by the plane at `place` along an axis; None without one."""
    low, high = Placed(solid, 1.0, turn, shift).bounds()
    if not low[axis] < place < high[axis]:
        return None
    a, b = (k for k in range(3) if k != axis)
    step = np.linalg.norm(high - low) / SECTION
    u, v = (np.arange(low[k] - step, high[k] + 2 * step, step) for k in (a, b))
    x = np.empty((len(u), len(v), 1, 3))
    x[..., axis], x[..., a], x[..., b] = place, u[:, None, None], v[None, :, None]
    plane = pyvista.StructuredGrid(*np.moveaxis(x, -1, 0))
    plane["distance"] = solid.distance((plane.points - shift) @ turn)
    cut = plane.clip_scalar(scalars="distance", value=0.0)
    cut.clear_data()
    return cut if cut.n_points else None


def polydata(vertices, triangles):
    faces = np.hstack([np.full((len(triangles), 1), 3), triangles])
    return pyvista.PolyData(np.array(vertices, float), faces.ravel())


def box(low, high, faces):
    """The named faces of a box, outward."""
    low, high = np.array(low, float), np.array(high, float)
    quads, points = [], []
    for name in faces:
        axis, upper = "xyz".index(name[0]), name[1] == "+"
        a, b = ((axis + 1) % 3, (axis + 2) % 3)
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)) if upper else ((0, 0), (0, 1), (1, 1), (1, 0)):
            corner = np.empty(3)
            corner[axis], corner[a], corner[b] = (low, high)[upper][axis], (low, high)[u][a], (low, high)[v][b]
            points.append(corner)
        quads.append([4, *range(len(points) - 4, len(points))])
    return pyvista.PolyData(np.array(points), np.ravel(quads)) if quads else None
