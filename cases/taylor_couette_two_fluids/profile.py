#!/usr/bin/env python3
"""Compares the flow between two cylinders with its profile for a symmetric stress.

    profile.py RUN_DIR

The velocity around the axis, the mean of rings half a spacing wide over the last quarter of the run, is taken at the mean
radius of their particles against both curves of profiles.csv. Writes RUN_DIR/profile.csv and exits with 1 where the root mean square of the difference to the
curve of the symmetric stress exceeds 3 % of the outer cylinder's speed.
"""

import csv
import sys
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "tools"))
from frames import Frames  # noqa: E402

INNER, OUTER = 10.0, 20.0


def curves():
    table = {}
    with open(HERE / "profiles.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            table.setdefault(row["interface"], []).append((float(row["r"]), float(row["u_theta"]) / OUTER))
    return {name: np.array(points).T for name, points in table.items()}


def main(arguments):
    if len(arguments) != 1:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    run = Path(arguments[0])
    with open(run / "case.resolved.toml", "rb") as file:
        case = tomllib.load(file)
    rate = next(b["motion"]["rate"] for b in case["wall"]["body"] if b["name"] == "outer")
    width, speed = case["fluid"]["dx"] / 2, rate * OUTER
    frames = Frames(run / "fluid.vtkhdf")
    edges = np.arange(INNER, OUTER + width / 2, width)
    sums, radii, counts = np.zeros((3, len(edges) - 1))
    for k, t in enumerate(frames.times):
        if t < 0.75 * frames.times[-1]:
            continue
        x, v = frames.position(k), frames.get(k, "velocity")
        r = np.hypot(x[:, 0], x[:, 1])
        around = (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]) / r / speed
        sums += np.histogram(r, edges, weights=around)[0]
        radii += np.histogram(r, edges, weights=r)[0]
        counts += np.histogram(r, edges)[0]
    filled = counts > 0
    middle, mean = radii[filled] / counts[filled], sums[filled] / counts[filled]
    rms = {}
    for name, (r, u) in curves().items():
        rms[name] = float(np.sqrt(np.mean((mean - np.interp(middle, r, u)) ** 2)))
    with open(run / "profile.csv", "w", encoding="utf-8") as table:
        table.write("r,u_theta\n" + "".join(f"{r:.6g},{u:.6g}\n" for r, u in zip(middle, mean)))
    passed = rms["symmetric_stress"] <= 0.03
    print(f"rms of the difference over the outer speed: {rms['symmetric_stress']:.4f} to the symmetric stress, "
          f"{rms['non_symmetric_stress']:.4f} to the other")
    print(f"{'pass' if passed else 'FAIL'}  {case['fluid']['model']} within 0.03 of the symmetric stress")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
