"""Writes pair.csv into a results folder: how the two spheres lie to each other, and the phases so far.

Phase 1, drafting: the one behind sinks faster by a tenth. 2, kissing: less than a twentieth of a diameter lies between
them. 3, tumbling: their line of centres leans by more than 45 degrees. 4, apart: the one that was behind is ahead, and
more than a tenth of a diameter lies between them. Each counts only after the one before.

Usage: python3 measure.py RESULTS
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames  # noqa: E402

run = Path(sys.argv[1])
frames = Frames(run / "grains.vtkhdf")
lines = ["time [s],phase [-],distance [-],height [-],inclination [deg],speed_ahead [m/s],speed_behind [m/s]"]
phase = 0
for k, time in enumerate(frames.times):
    order = np.argsort(frames.get(k, "id"))
    x, v = frames.position(k)[order], frames.get(k, "velocity")[order]
    between = (x[1] - x[0]) / (2 * frames.get(k, "radius")[0])  # from the one ahead at the start, in diameters
    distance, sunk = np.linalg.norm(between), -v[:, 2]
    inclination = np.degrees(np.arccos(between[2] / distance))
    steps = (sunk[1] > 1.1 * sunk[0] > 0, distance < 1.05, inclination > 45, between[2] < 0 and distance > 1.1)
    while phase < 4 and steps[phase]:
        phase += 1
    lines.append(f"{time:.6g},{phase},{distance:.5g},{between[2]:.5g},{inclination:.4g},{sunk[0]:.5g},{sunk[1]:.5g}")
(run / "pair.csv").write_text("\n".join(lines) + "\n")
