"""Lines by which solids are drawn: their edges as seen from afar, or their cut by a plane."""

import numpy as np

CREASE = np.cos(np.radians(25))  # edges sharper than this are drawn


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
