#!/usr/bin/env python3
"""Makes solids of triangles for `[[shape]] kind = "mesh"`: watertight and outward by construction.

    solids.py hopper   OUT.stl [--radius R --orifice D --angle DEG ...]
    solids.py impeller OUT.stl [--kind rushton | paddle | pitched ...]
    solids.py tube     OUT.stl [--inner R --outer R --around N --rows N ...]

Lengths in m, angles in degrees; -h after a kind lists its parameters. The axis of a hopper and an impeller
is z, that of a tube x. Every surface comes from one of two constructions: a profile turned about an axis, or
a plane figure of cells that fills some of several layers and is then mapped into space.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "src" / "python"))
from bedload._surfaces import Mesh, halves, revolve  # noqa: E402

def layered(cells, filled, levels):
    """The solid of those prisms over `cells` that are `filled`.

    cells [c, 4] number the nodes of a plane figure, counter-clockwise, a node twice for a triangle; layer l
    lies between levels[l] and levels[l + 1], each [nodes, 3]; filled [layers, c]. Where only one of two
    neighbouring prisms is filled, their common side is surface.
    """
    nodes = len(levels[0])
    quads = []
    closed = np.zeros((1, len(cells)), bool)
    for level, (below, above) in enumerate(zip(np.vstack([closed, filled]), np.vstack([filled, closed]))):
        quads += [cells[below & ~above] + level * nodes, cells[above & ~below][:, ::-1] + level * nodes]
    for layer, inside in enumerate(filled):
        a = cells[inside].ravel()
        b = np.roll(cells[inside], -1, axis=1).ravel()
        rim = ~np.isin(a * nodes + b, b * nodes + a) & (a != b)
        a, b = a[rim] + layer * nodes, b[rim] + layer * nodes
        quads.append(np.stack([a, b, b + nodes, a + nodes], axis=1))
    vertices, triangles = np.concatenate(levels), halves(np.concatenate(quads))
    used, triangles = np.unique(triangles, return_inverse=True)
    return Mesh(vertices[used], triangles.reshape(-1, 3))


# ---- things to make ----


def hopper(radius=0.025, orifice=0.016, angle=45.0, height=0.08, thickness=0.003, facets=48):
    """A cylinder upon a cone that narrows to the orifice at z = 0, open above.

    radius, height: of the inside of the cylinder, and the top above the orifice; orifice: its diameter;
    angle: of the cone's wall against the vertical; thickness: of the wall.
    """
    sine, cosine = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    r = orifice / 2
    bend = (radius - r) * cosine / sine
    along = (radius + thickness - r - thickness * cosine) / sine  # the outside of the cone up to that of the cylinder
    if not 0 < bend < height:
        raise SystemExit("hopper: the cone must end between the orifice and the top")
    return revolve([(r, 0), (r + thickness / cosine, 0), (radius + thickness, along * cosine - thickness * sine),
                    (radius + thickness, height), (radius, height), (radius, bend)], facets)


def impeller(kind="rushton", diameter=0.05, blades=6, width=0.01, length=0.0125, thickness=0.005,
             disc=0.0375, hub=0.015, shaft=0.01, top=0.1, pitch=45.0, facets=8):
    """Blades about a hub at z = 0, with a shaft up to `top`.

    kind: rushton (blades upright across the rim of a disc), paddle (upright on the hub) or pitched (the same,
    leaning); diameter, width and length: of the blades, width along z before leaning; thickness: of blades and
    disc; disc, hub, shaft: diameters; pitch: angle of leaning blades against the plane of rotation;
    facets: sides of the hub between two blades.
    """
    if kind not in ("rushton", "paddle", "pitched"):
        raise SystemExit(f"impeller: no kind '{kind}'")
    lean = 1 / np.tan(np.radians(pitch)) if kind == "pitched" else 0.0  # sideways by height
    half = width / 2 * (np.sin(np.radians(pitch)) if kind == "pitched" else 1)
    edge = thickness / 2 * np.hypot(1, lean)  # from the middle of a blade to its side, level
    radii = np.array([shaft, hub, diameter - 2 * length, disc, diameter] if kind == "rushton"
                     else [shaft, hub, diameter]) / 2
    if np.any(np.diff(radii) <= 0):
        raise SystemExit("impeller: diameters of shaft, hub, inner ends of blades, disc and blades must grow")
    if edge + half * lean >= 0.95 * radii[1]:
        raise SystemExit("impeller: the hub is too thin to carry these blades")

    # Cells between rings of nodes; columns 0 of every `facets + 1` lie in a blade.
    columns = blades * (facets + 1)
    number = 1 + np.arange(len(radii) * columns).reshape(len(radii), columns)  # node 0 is the middle
    onward = np.roll(number, -1, axis=1)
    middle = np.stack([np.zeros(columns, int), np.zeros(columns, int), number[0], onward[0]], axis=1)
    bands = [np.stack([a, b, c, d], axis=1) for a, b, c, d in zip(number, number[1:], onward[1:], onward)]
    cells = np.concatenate([middle, *bands])
    band = np.repeat(np.arange(len(radii)), columns)
    blade = np.tile(np.arange(columns) % (facets + 1) == 0, len(radii))

    shaft_, hub_ = band == 0, band <= 1
    if kind == "rushton":
        heights = [-half, -thickness / 2, thickness / 2, half, top]
        arms = hub_ | (blade & (band >= 3))
        filled = [arms, arms | (band <= 3), arms, shaft_]
    else:
        heights = [*np.linspace(-half, half, 5 if lean else 2), top]
        filled = [hub_ | blade] * (len(heights) - 2) + [shaft_]

    def level(z):
        sideways = np.clip(z, -half, half) * lean
        places = [np.zeros((1, 3))]
        for r in radii:
            sides = np.arcsin(np.array([sideways - edge, sideways + edge]) / max(r, radii[1]))
            between = np.linspace(sides[1], sides[0] + 2 * np.pi / blades, facets + 1)
            turn = np.concatenate([[sides[0]], between[:-1]])
            angle = (turn + 2 * np.pi / blades * np.arange(blades)[:, None]).ravel()
            places.append(np.stack([r * np.cos(angle), r * np.sin(angle), np.zeros(columns)], axis=1))
        return np.concatenate(places) + [0, 0, z]

    return layered(cells, np.array(filled), [level(z) for z in heights])


def tube(inner=0.0069, outer=0.0072, around=4, rows=4, pitch=0.01, along=0.007, across=0.005, stagger=True,
         side=6, rings=3):
    """A tube about x from 0 to rows * pitch whose wall has rows of elliptic holes; rows repeat periodically.

    inner, outer: radii; around: holes in a row; pitch: from row to row; along, across: a hole's diameters along
    the axis and around it, there measured on the outside; stagger: every other row turned by half a hole;
    side: nodes on each side of the cell about a hole; rings: of cells about a hole.
    """
    wide = 2 * np.pi * outer / around
    if along >= pitch or across >= wide:
        raise SystemExit(f"tube: holes must be smaller than their cells, {pitch:g} m by {wide:g} m")
    if side % 2 or (stagger and rows % 2):
        raise SystemExit("tube: side must be even, and rows too if staggered")
    # One cell about the origin: its rim counter-clockwise in units of its halves, and rings from the hole to it.
    step = 2 * np.arange(side) / side - 1
    one = np.ones(side)
    rim = np.concatenate([np.stack(p, axis=1) for p in ((step, -one), (one, step), (-step, one), (-one, -step))])
    rim_place = rim * [pitch / 2, wide / 2]
    hole = rim / np.linalg.norm(rim, axis=1, keepdims=True) * [along / 2, across / 2]
    fraction = np.linspace(0, 1, rings + 1)[:, None, None]
    sheet = ((1 - fraction) * hole + fraction * rim_place).reshape(-1, 2)
    number = np.arange(len(sheet)).reshape(rings + 1, -1)
    onward = np.roll(number, -1, axis=1)
    cell = np.concatenate([np.stack(q, axis=1) for q in zip(number, number[1:], onward[1:], onward)])

    # Copies side by side; nodes on common sides become one, as they differ by whole steps of the sides.
    nodes, cells = [], []
    for row in range(rows):
        for k in range(around):
            shift = 0.5 * (row % 2) if stagger else 0.0
            cells.append(cell + len(sheet) * len(nodes))
            nodes.append(sheet + [(row + 0.5) * pitch, (k + 0.5 + shift) * wide])
    nodes = np.concatenate(nodes)
    grid = np.rint(nodes / [pitch / side, wide / side] * 2**20).astype(np.int64)
    grid[:, 1] %= around * side * 2**20
    _, first, same = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    x, angle = nodes[first, 0], nodes[first, 1] / outer

    def level(r):
        return np.stack([x, r * np.cos(angle), r * np.sin(angle)], axis=1)

    cells = same.ravel()[np.concatenate(cells)]
    return layered(cells, np.ones((1, len(cells)), bool), [level(outer), level(inner)])  # x, angle: seen from inside


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(required=True)
    for make in (hopper, impeller, tube):
        kind = kinds.add_parser(make.__name__, help=make.__doc__.splitlines()[0], description=make.__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
        kind.add_argument("out", help="STL file to write")
        names = make.__code__.co_varnames[: make.__code__.co_argcount]
        for name, value in zip(names, make.__defaults__):
            how = {"action": argparse.BooleanOptionalAction} if value is True else {"type": type(value)}
            kind.add_argument("--" + name, default=value, help=f"default {value}", **how)
        kind.set_defaults(make=make)
    options = vars(parser.parse_args())
    make, out = options.pop("make"), options.pop("out")
    mesh = make(**options)
    mesh.write_stl(out)
    print(f"{out}: {len(mesh.triangles)} triangles, {1e6 * mesh.volume():.4g} cm3")


if __name__ == "__main__":
    main()
