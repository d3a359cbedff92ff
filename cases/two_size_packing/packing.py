#!/usr/bin/env python3
"""Solid fraction of the bed, by sizes, and the force on the floor over the weight.

    packing.py RUN_DIR

For each frame the volume of grains, exactly cut, between two large diameters above the floor and two below the surface
of the bed, which is twice as high as the centre of mass; and the mean force on the floor since the frame before. Writes
RUN_DIR/packing.csv and prints the last row.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of, write_table  # noqa: E402

NAMES = ["time [s]", "height [m]", "solid_fraction [-]", "large [-]", "small [-]", "floor_over_weight [-]"]


def between(z, radius, low, high):
    """Volumes of spheres between two heights."""
    def up_to(height):
        t = np.clip(height - z, -radius, radius)
        return np.pi * (radius**2 * t - t**3 / 3)
    return up_to(high) - up_to(low)


def main():
    run = Path(sys.argv[1])
    case, grains, floor = case_of(run), Frames(run / "grains.vtkhdf"), Table(run / "probes" / "floor.csv")
    low, high = (np.array(case["domain"][key]) for key in ("min", "max"))
    area = np.prod((high - low)[:2])
    weight = Table(run / "diagnostics.csv")["grain_mass"][-1] * -case["gravity"][2]
    rows, before = [], -np.inf
    for frame, time in enumerate(grains.times):
        z, radius = grains.position(frame)[:, 2], grains.get(frame, "radius")
        height = 2 * np.average(z, weights=radius**3)
        bottom, top = 4 * radius.max(), height - 4 * radius.max()
        solid = between(z, radius, bottom, top) / (area * (top - bottom))
        large = solid[radius > 0.9 * radius.max()].sum()
        since = (floor["time"] > before + 1e-9) & (floor["time"] <= time + 1e-9)
        force = -floor["force_by_grains_z"][since].mean()
        rows.append([time, height, solid.sum(), large, solid.sum() - large, force / weight])
        before = time
    write_table(run / "packing.csv", NAMES, rows)
    for name, value in zip(NAMES, rows[-1]):
        print(f"{name:22} {value:.5g}")


if __name__ == "__main__":
    main()
