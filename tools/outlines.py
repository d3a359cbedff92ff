"""Lines by which the named shapes of a case are drawn: their edges as seen from afar, or their cut by a plane."""

import numpy as np

from solids import Mesh, read_stl, revolve

FACETS = 72
CREASE = np.cos(np.radians(25))  # edges sharper than this are drawn


def surfaces(name, shapes, folder):
    """Meshes that bound the shape `name`; of sums and vessels the parts that they are made of.

    shapes: the [[shape]] tables by their names; folder: where mesh files with relative names lie.
    """
    shape = shapes[name]
    if "of" in shape:
        found = [mesh for part in shape["of"] for mesh in surfaces(part, shapes, folder)]
    else:
        mesh = primitive(shape, folder)
        found = [mesh] if mesh else []
    scale, turned, shift = placement(shape)
    found = [Mesh(scale * mesh.vertices @ turned.T + shift, mesh.triangles) for mesh in found]
    return [Mesh(mesh.vertices @ turned.T + shift, mesh.triangles) for turned, shift in copies(shape) for mesh in found]


def placement(shape):
    """Scale, turn and shift of a shape: x becomes scale turn x + shift."""
    turned = rotation(shape.get("turn_axis", [0, 0, 1]), np.radians(shape.get("turn_angle", 0.0)))
    return shape.get("scale", 1.0), turned, np.array(shape.get("translate", [0.0] * 3), float)


def copies(shape):
    """Turn and shift of each copy of a placed shape, the first among them."""
    given = shape.get("copies", {})
    count, about = given.get("count", 1), given.get("about", [0, 0, 0])
    centre, along = (np.array(given.get(key, [0, 0, 0]), float) for key in ("centre", "along"))
    angle = given.get("angle", 360 / count)
    found = []
    for k in range(count):
        turned = rotation(about, np.radians(k * angle)) if np.any(about) else np.eye(3)
        found.append((turned, centre - turned @ centre + k * along))
    return found


def primitive(shape, folder):
    """Mesh of a shape that is made of no others, before it is placed and copied; None for a file that is not STL."""
    kind = shape["kind"]
    if kind == "mesh":
        path = folder / shape["file"]
        return read_stl(path) if path.suffix.lower() == ".stl" and path.exists() else None
    if kind == "box":
        low, high = np.array(shape["min"]), np.array(shape["max"])
        square = revolve([(0, 0), (np.sqrt(0.5), 0), (np.sqrt(0.5), 1), (0, 1)], 4)
        eighth = rotation([0, 0, 1], np.pi / 4)
        return Mesh((square.vertices @ eighth.T + [0.5, 0.5, 0]) * (high - low) + low, square.triangles)
    if kind == "sphere":
        r = shape["radius"]
        return lathe([(r * np.cos(a), r * np.sin(a)) for a in arc(-90, 90)], shape["centre"], [0, 0, 1])
    a, b = np.array(shape["a"]), np.array(shape["b"])
    length = float(np.linalg.norm(b - a))
    r = shape.get("radius", 0.0)
    if kind == "capsule":
        caps = [(r * np.cos(s), r * np.sin(s) + (length if s > 0 else 0)) for s in [*arc(-90, -1), *arc(1, 90)]]
        return lathe(caps, a, b - a)
    if kind == "pipe":
        t, ends = shape.get("thickness", 0.1 * r), shape.get("ends", "open")
        bottom = [(0, 0), (0, -t), (r + t, -t)] if ends in ("closed_a", "closed") else [(r + t, 0)]
        top = [(r + t, length)]
        if ends in ("closed_b", "closed"):
            top = [(r + t, length + t), (0, length + t), (0, length)]
        return lathe([(r, 0), *bottom, *top, (r, length)], a, b - a)
    ends = (shape["radius_a"], shape["radius_b"]) if kind == "cone" else (r, r)
    return lathe([(0, 0), *((e, z) for e, z in zip(ends, (0, length)) if e > 0), (0, length)], a, b - a)


def arc(first, last):
    return np.radians(np.linspace(first, last, FACETS // 4))


def lathe(profile, foot, axis):
    """A profile of (r, z) turned about `axis`, z counted from `foot`."""
    profile = [(0.0 if r < 1e-12 else r, z) for r, z in profile]
    mesh = revolve(profile, FACETS)
    axis = np.array(axis, float) / np.linalg.norm(axis)
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across /= np.linalg.norm(across)
    return Mesh(mesh.vertices @ np.stack([across, np.cross(axis, across), axis]) + foot, mesh.triangles)


def rotation(axis, angle):
    """Matrix of a right-handed turn about `axis` through the origin."""
    x, y, z = np.array(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def motion_between(before, after):
    """Turn and shift (R, s), after = before R^T + s, of a rigid body by least squares over its points [n, 3]."""
    middle, now = before.mean(axis=0), after.mean(axis=0)
    u, _, v = np.linalg.svd((before - middle).T @ (after - now))
    turn = v.T @ np.diag([1, 1, np.sign(np.linalg.det(v.T @ u.T))]) @ u.T
    return turn, now - middle @ turn.T


def edges(mesh, depth):
    """Ends [n, 2, 3] of the edges that show from far along axis `depth`: creases and the silhouette."""
    normals = mesh.normals()
    sides = np.concatenate([mesh.triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    owner = np.tile(np.arange(len(mesh.triangles)), 3)
    order = np.lexsort(np.sort(sides, axis=1).T)
    sides, owner = sides[order], owner[order]  # of a closed surface every edge twice in a row
    one, other = normals[owner[0::2]], normals[owner[1::2]]
    seen = np.sum(one * other, axis=1) < CREASE
    seen |= (one[:, depth] > 1e-6) != (other[:, depth] > 1e-6)
    return mesh.vertices[sides[0::2][seen]]


def cut(mesh, depth, place):
    """Ends [n, 2, 3] of the lines in which the plane at `place` along axis `depth` cuts the surface."""
    corners = mesh.corners()
    above = corners[:, :, depth] > place
    crossed = corners[above.any(axis=1) & ~above.all(axis=1)]
    lines = np.empty((len(crossed), 2, 3))
    found = np.zeros(len(crossed), int)
    for k in range(3):
        a, b = crossed[:, k], crossed[:, (k + 1) % 3]
        meets = np.flatnonzero((a[:, depth] > place) != (b[:, depth] > place))
        fraction = (place - a[meets, depth]) / (b[meets, depth] - a[meets, depth])
        lines[meets, found[meets]] = a[meets] + fraction[:, None] * (b - a)[meets]
        found[meets] += 1
    return lines
