#!/usr/bin/env python3
"""Makes valley.asc, the height map of the case: a gully that falls by 32 degrees, bends, and runs out at 5 degrees.
Usage: make_valley.py [OUT.asc]"""

import sys

import numpy as np

CELL, LENGTH, WIDTH = 0.02, 1.7, 0.36  # m
STEEP, FLAT = np.radians(32), np.radians(5)
BEND, RADIUS = 0.75, 0.8  # where it begins, and its radius, m
SIDES = 2.4  # 1/m: banks rise by SIDES y^2


def profile(x):
    """Height of the bottom of the gully over x, m: straight, an arc of a circle, straight."""
    end = BEND + RADIUS * (np.sin(STEEP) - np.sin(FLAT))
    low = -BEND * np.tan(STEEP) - RADIUS * (np.cos(FLAT) - np.cos(STEEP))
    angle = np.arcsin(np.clip(np.sin(STEEP) - (x - BEND) / RADIUS, np.sin(FLAT), np.sin(STEEP)))
    arc = -BEND * np.tan(STEEP) - RADIUS * (np.cos(angle) - np.cos(STEEP))
    return np.where(x < BEND, -x * np.tan(STEEP), np.where(x < end, arc, low - (x - end) * np.tan(FLAT)))


def main():
    x = np.arange(round(LENGTH / CELL) + 1) * CELL
    y = np.arange(round(WIDTH / CELL) + 1) * CELL - WIDTH / 2
    z = profile(x) - profile(LENGTH) + SIDES * y[::-1, None] ** 2
    with open(sys.argv[1] if len(sys.argv) > 1 else "valley.asc", "w") as file:
        file.write(f"ncols {len(x)}\nnrows {len(y)}\nxllcenter 0\nyllcenter {y[0]:g}\ncellsize {CELL:g}\n")
        for row in z:
            file.write(" ".join(f"{height:.4f}" for height in row) + "\n")


if __name__ == "__main__":
    main()
