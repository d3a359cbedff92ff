#!/usr/bin/env python3
"""Lift of each size of grains, over its buoyancy.

    lift.py RUN_DIR

The vertical force of the fluid on all grains of a size, over rho g V of the same grains, for each frame. Writes
RUN_DIR/lift.csv and prints the means from 0.05 s on, when the pressure is hydrostatic.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, case_of, write_table  # noqa: E402

START = 0.05  # s
NAMES = ["time [s]", "lift_small [-]", "lift_large [-]", "speed_small [m/s]", "speed_large [m/s]"]


def main():
    run = Path(sys.argv[1])
    case, grains = case_of(run), Frames(run / "grains.vtkhdf")
    weight = case["fluid"]["rho0"] * -case["gravity"][2]
    rows = []
    for frame, time in enumerate(grains.times):
        radius = grains.get(frame, "radius")
        buoyancy = weight * 4 / 3 * np.pi * radius**3
        force = grains.get(frame, "fluid_force")[:, 2]
        speed = np.linalg.norm(grains.get(frame, "velocity"), axis=1)
        sizes = [radius < np.sqrt(radius.min() * radius.max()), radius > np.sqrt(radius.min() * radius.max())]
        rows.append([time, *(force[size].sum() / buoyancy[size].sum() for size in sizes),
                     *(speed[size].max() for size in sizes)])
    write_table(run / "lift.csv", NAMES, rows)
    table = np.array(rows)
    late = table[table[:, 0] >= START]
    if len(late) == 0:
        sys.exit(f"{run}: ends before {START:g} s")
    for k, size in enumerate(("small", "large"), 1):
        print(f"lift of {size} grains over rho g V {late[:, k].mean():.5f}, {late[:, k].min():.5f} to "
              f"{late[:, k].max():.5f}; fastest in any frame {table[:, k + 2].max():.3g} m/s")


if __name__ == "__main__":
    main()
