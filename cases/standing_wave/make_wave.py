#!/usr/bin/env python3
"""Writes the particles of a standing wave at its highest, which `fluid.fill.file` reads.

    make_wave.py FILE WAVELENGTH DEPTH AMPLITUDE DX LAYERS

All in m. A lattice of spacing DX, LAYERS thick along y, is moved as linear theory moves fluid in a wave with its crest
at x = 0: by -a cosh(k (z + H)) / sinh(k H) sin(k x) along x and a sinh(k (z + H)) / sinh(k H) cos(k x) along z. Rows
lie such that each particle has the area dx^2 to within 6e-4 (the displacement alone leaves a^2 k^2, 1.6 % at a surface
of a/wavelength = 0.02). Still water is at z = 0, the floor at -H.
"""

import sys

import numpy as np


def main(file, *numbers):
    wavelength, depth, a, dx = (float(n) for n in numbers[:4])
    layers, k = int(numbers[4]), 2 * np.pi / wavelength
    sinh = np.sinh(k * depth)

    z = np.arange(-depth + dx / 2, 0, dx)
    b = z.copy()  # row whose strip holds as much as a strip of still water from the floor up to z
    for _ in range(20):
        b = z + (a * k / sinh) ** 2 * (np.sinh(2 * k * (b + depth)) / (4 * k) - (b + depth) / 2)

    with open(file, "w") as out:
        out.write("x,y,z\n")
        for y in (np.arange(layers) + 0.5) * dx:
            for row in b:
                for x in np.arange(dx / 2, wavelength, dx):
                    at = (x - a * np.cosh(k * (row + depth)) / sinh * np.sin(k * x)) % wavelength
                    up = row + a * np.sinh(k * (row + depth)) / sinh * np.cos(k * x)
                    out.write(f"{at:.5g},{y:.5g},{up:.5g}\n")


if __name__ == "__main__":
    if len(sys.argv) != 7:
        sys.exit(__doc__)
    main(*sys.argv[1:])
