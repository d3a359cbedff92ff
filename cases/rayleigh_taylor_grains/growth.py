#!/usr/bin/env python3
"""Amplitude of the wave of the interface over time.

    growth.py RUN_DIR

The amplitude, in units of 1/k, is told by the grains that are missing above its crests, -2 sum cos(k x) / (n A) over
all grains; n is their number density, A the section. The speed of the wave is that of the water that moves with it.
Writes RUN_DIR/wave.csv; compare.py fits the rate and compares it with Chandrasekhar's dispersion relation.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, case_of, write_table  # noqa: E402

POROSITY = 0.9  # of the suspension


def main(arguments):
    if len(arguments) != 1:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    run = Path(arguments[0])
    case = case_of(run)
    width, depth = case["domain"]["max"][:2]
    k = 2 * np.pi / width
    grains, fluid = Frames(run / "grains.vtkhdf"), Frames(run / "fluid.vtkhdf")
    density = (1 - POROSITY) / (np.pi / 6 * case["grain"]["d"] ** 3)
    rows = []
    for f, time in enumerate(grains.times):
        amplitude = -2 * k * np.cos(k * grains.position(f)[:, 0]).sum() / (density * width * depth)
        w = fluid.get(f, "velocity")[:, 2]
        rows.append([time, amplitude, 2 * np.mean((w - w.mean()) * np.cos(k * fluid.position(f)[:, 0]))])
    write_table(run / "wave.csv", ["time [s]", "amplitude [1/k]", "speed [m/s]"], rows)
    for time, amplitude, speed in rows[:: max(1, len(rows) // 10)]:
        print(f"{time:.4f} s  amplitude {amplitude:.4f} / k, water {1e3 * speed:.4f} mm/s")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
