#!/usr/bin/env python3
"""Size and slope of the bed in the rotating drum.

    bed.py RUN_DIR [--start S] [--samples N] [--every S]

Looks along the axis of the drum, y. Width and height of the bed are the extents along x and z of all grains, as a
camera sees them through the end of the drum; `compact`, without lone ones: where grains cover more than half of
the square of two diameters about a place. Samples N frames `every` seconds apart from `start` on, and writes
RUN_DIR/bed.csv and RUN_DIR/bed.png: one moment, and the mean bed with two straight lines fitted to the surface of its
core, where grains fill more than 0.3 of the drum's length, half of what they fill in a packing.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import EllipseCollection  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, case_of, write_table  # noqa: E402

CELL = 0.5e-3  # m
FILLED = 0.3


class Drum:
    """The drum of the case: radius and length of its inside, m."""

    def __init__(self, run):
        shapes = {shape["name"]: shape for shape in case_of(run)["shape"]}
        inside = shapes["inside"]
        scale = inside["scale"]
        self.radius = scale * inside["radius"]
        self.length = scale * np.linalg.norm(np.subtract(inside["b"], inside["a"]))
        self.arrange()

    def arrange(self):
        cells = int(np.ceil(2 * self.radius / CELL))
        self.edges = (np.arange(cells + 1) - cells / 2) * CELL
        self.centres = (self.edges[1:] + self.edges[:-1]) / 2

    def filled(self, x, radius):
        """Fraction of the length that grains fill, [x, z]: every grain by its chord along the axis."""
        fraction = np.zeros((len(self.centres), len(self.centres)))
        reach = int(np.ceil(radius.max() / CELL)) + 1
        at = np.floor((x[:, [0, 2]] - self.edges[0]) / CELL).astype(int)
        for i in range(-reach, reach + 1):
            for j in range(-reach, reach + 1):
                cell = at + [i, j]
                inside = np.all((cell >= 0) & (cell < len(self.centres)), axis=1)
                cell = cell[inside]
                r2 = (self.centres[cell[:, 0]] - x[inside, 0]) ** 2 + (self.centres[cell[:, 1]] - x[inside, 2]) ** 2
                chord = 2 * np.sqrt(np.maximum(radius[inside] ** 2 - r2, 0))
                np.add.at(fraction, (cell[:, 0], cell[:, 1]), chord / self.length)
        return fraction

    def compact(self, fraction, d):
        """Width and height of where grains cover more than half of the square of side 2 d about a place, m."""
        half = round(d / CELL)
        side = 2 * half + 1
        sums = np.pad(fraction > 0, half + 1).astype(int).cumsum(axis=0).cumsum(axis=1)[:-1, :-1]
        covered = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
        bed = covered > side**2 / 2
        sides = [np.flatnonzero(bed.any(axis=other)) for other in (1, 0)]
        return [(side[-1] - side[0] + 1) * CELL for side in sides]

    def surface(self, fraction):
        """Top of the bed over x, m; where there is one, away from the drum's wall."""
        bed = fraction > FILLED
        columns = np.flatnonzero(bed.any(axis=1))
        top = np.array([self.centres[np.flatnonzero(bed[c]).max()] for c in columns])
        x = self.centres[columns]
        clear = np.hypot(x, top) < 0.93 * self.radius
        return x[clear], top[clear]


def extents(x, radius):
    """Of all grains along x and z, m."""
    return [(x[:, k] + radius).max() - (x[:, k] - radius).min() for k in (0, 2)]


def bilinear(x, z):
    """Two straight lines that meet: their slopes, the place of the bend and the rms misfit, by least squares."""
    best = None
    for bend in np.linspace(x[0], x[-1], 60)[5:-5]:
        terms = np.stack([np.ones_like(x), np.minimum(x - bend, 0), np.maximum(x - bend, 0)], axis=1)
        c, *_ = np.linalg.lstsq(terms, z, rcond=None)
        misfit = np.sqrt(np.mean((terms @ c - z) ** 2))
        if best is None or misfit < best[0]:
            best = (misfit, bend, c)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--start", type=float, default=5.0)
    parser.add_argument("--samples", type=int, default=50)
    parser.add_argument("--every", type=float, default=0.2)
    args = parser.parse_args()

    run = Path(args.run)
    drum = Drum(run)
    grains = Frames(run / "grains.vtkhdf")
    wanted = args.start + args.every * np.arange(args.samples)
    if grains.times[-1] < wanted[-1] - args.every / 2:
        raise SystemExit(f"{run}: ends at {grains.times[-1]:g} s, the samples at {wanted[-1]:g} s")
    rows, mean = [], 0
    for time in wanted:
        frame = grains.nearest(time)
        x, radius = grains.position(frame), grains.get(frame, "radius")
        fraction = drum.filled(x, radius)
        rows.append([grains.times[frame], *extents(x, radius), *drum.compact(fraction, 2 * radius.mean())])
        mean = mean + fraction / args.samples
    names = ["width", "height", "compact_width", "compact_height"]
    write_table(run / "bed.csv", ["time [s]"] + [f"{name} [m]" for name in names], rows)
    sizes = np.array(rows)[:, 1:] * 1000
    for name, column in zip(names, sizes.T):
        print(f"{name.replace('_', ' ')}: {column.mean():.2f} mm, standard deviation {column.std(ddof=1):.2f} mm")
    x, z = drum.surface(mean)
    misfit, bend, (level, left, right) = bilinear(x, z)
    print(f"surface: {np.degrees(np.arctan(left)):.1f} deg left of x = {1000 * bend:.1f} mm, "
          f"{np.degrees(np.arctan(right)):.1f} deg right of it; rms misfit {1000 * misfit:.2f} mm")
    draw(run, drum, grains, grains.nearest(wanted[-1]), mean, (x, level, bend, left, right))


def draw(run, drum, grains, frame, mean, fit):
    x, level, bend, left, right = fit
    figure, axes = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
    angle = np.linspace(0, 2 * np.pi, 361)
    for axis in axes:
        axis.plot(1000 * drum.radius * np.cos(angle), 1000 * drum.radius * np.sin(angle), color="#555555")
        axis.plot(1000 * x, 1000 * (level + left * np.minimum(x - bend, 0) + right * np.maximum(x - bend, 0)),
                  color="red", lw=2)
        axis.set_aspect("equal")
        axis.set_xlabel("x (mm)")
    axes[0].set_ylabel("z (mm)")
    water = Frames(run / "fluid.vtkhdf")
    w = water.position(frame) * 1000
    axes[0].scatter(w[:, 0], w[:, 2], s=4, color="#8ec1e8", lw=0)
    g, r = grains.position(frame) * 1000, grains.get(frame, "radius") * 1000
    front = np.argsort(-g[:, 1])
    axes[0].add_collection(EllipseCollection(2 * r[front], 2 * r[front], np.zeros(len(r)), units="xy",
                                             offsets=g[front][:, [0, 2]], transOffset=axes[0].transData,
                                             facecolor="#e7b64c", edgecolor="#5b3416", lw=0.3))
    axes[0].set_title(f"t = {grains.times[frame]:.2f} s")
    edge = 1000 * drum.edges
    picture = axes[1].pcolormesh(edge, edge, mean.T, cmap="YlOrBr", vmin=0, vmax=0.65)
    axes[1].contour(1000 * drum.centres, 1000 * drum.centres, mean.T, [FILLED], colors="black", linewidths=1)
    axes[1].set_title("mean fraction filled by grains")
    figure.colorbar(picture, ax=axes[1])
    figure.savefig(run / "bed.png", dpi=120)


if __name__ == "__main__":
    main()
