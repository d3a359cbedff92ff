#!/usr/bin/env python3
"""What an engineer asks of a run of the case: flow in and out, gravel in and out, depth, and what is left on the floor.
Usage: launder.py RESULTS [--start S]

Rates are means from `start` on. A grain is at rest below 2 cm/s; the deposit is as deep as these grains, packed at a
solid fraction of 0.6, over the floor between the feed and the end."""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of  # noqa: E402

WIDTH, LENGTH = 0.048, 0.52  # m, of the floor below the gravel inlet
REST, PACKED = 0.02, 0.6  # m/s; solid fraction of a bed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--start", type=float, default=1.2, help="s; default 1.2")
    args = parser.parse_args()
    run = Path(args.run)
    case, total = case_of(run), Table(run / "diagnostics.csv")
    probe = {path.stem: Table(path) for path in run.glob("probes/*.csv")}
    time = total["time"]
    late = time >= args.start
    if late.sum() < 2:
        sys.exit(f"{run}: ends before --start {args.start:g}")

    def rate(column):
        """Slope of a total from `start` on, by least squares."""
        return float(np.polyfit(time[late], total[column][late], 1)[0])

    def mean(table, column):
        return float(np.mean(table[column][table["time"] >= args.start]))

    frames = Frames(run / "grains.vtkhdf")
    last = len(frames.times) - 1
    x, speed = frames.position(last), np.linalg.norm(frames.get(last, "velocity"), axis=1)
    lies = (speed < REST) & (x[:, 0] < 0.6)
    volume = np.pi / 6 * case["grain"]["d"] ** 3
    depth = mean(probe["depth"], "column_depth")
    water = rate("outlet_end_fluid_mass") / case["fluid"]["rho0"]
    gravel, deposit = rate("outlet_end_grain_mass"), lies.sum() * volume / PACKED / WIDTH / LENGTH
    came, went = total["grain_inlet_gravel_mass"], total["outlet_end_grain_mass"]
    rows = [("water in, out", f"{1000 * rate('inlet_feed_volume'):.3f} l/s, {1000 * water:.3f} l/s"),
            ("gravel in, out", f"{1000 * rate('grain_inlet_gravel_mass'):.1f} g/s, "
                               f"{1000 * gravel:.1f} g/s"),
            ("gravel by mass of what flows out", f"{100 * gravel / (gravel + water * case['fluid']['rho0']):.1f} %"),
            ("depth, mean speed in the middle", f"{1000 * depth:.0f} mm, {water / depth / WIDTH:.2f} m/s"),
            ("Froude number", f"{water / depth / WIDTH / np.sqrt(9.81 * depth):.2f}"),
            ("gravel: speed on average", f"{float(np.mean(speed)):.2f} m/s"),
            ("gravel at rest", f"{100 * lies.mean():.0f} % of {len(x)} grains, deposit {1000 * deposit:.1f} mm"),
            ("gravel: in - out - in the channel", f"{abs(came[-1] - went[-1] - total['grain_mass'][-1]):.1e} kg")]
    for what, value in rows:
        print(f"{what:40} {value}")


if __name__ == "__main__":
    main()
