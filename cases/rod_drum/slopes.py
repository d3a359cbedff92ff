#!/usr/bin/env python3
"""Slopes of the beds in the two drums.

    slopes.py RUN_DIR [START]

A bed with a flat surface lies in a drum like a segment of a circle: the line from the axis to its centre of mass is
normal to the surface. Writes the angle of that line from the vertical in RUN_DIR/slopes.csv, for each frame from START
on (s, default 1.25), and prints the means.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, write_table  # noqa: E402

AXES = {"spheres": -0.06, "rods": 0.06}  # x, m
NAMES = ["time [s]", "spheres [deg]", "rods [deg]", "difference [deg]"]


def slope(x, mass, axis):
    """The drum turns z to x: the bed rises to smaller x."""
    here = (x[:, 0] > 0) == (axis > 0)
    centre = np.average(x[here], axis=0, weights=mass[here])
    return np.degrees(np.arctan2(axis - centre[0], -centre[2]))


def main():
    run, start = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 1.25
    grains = Frames(run / "grains.vtkhdf")
    rows = []
    for frame, time in enumerate(grains.times):
        if time < start - 1e-6:
            continue
        x, mass = grains.position(frame), grains.get(frame, "radius") ** 3
        spheres, rods = (slope(x, mass, axis) for axis in AXES.values())
        rows.append([time, spheres, rods, rods - spheres])
    write_table(run / "slopes.csv", NAMES, rows)
    for name, column in zip(NAMES[1:], np.array(rows).T[1:]):
        print(f"{name:18} {column.mean():.2f}, standard deviation {column.std(ddof=1):.2f}")


if __name__ == "__main__":
    main()
