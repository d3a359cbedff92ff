#!/usr/bin/env python3
"""What an engineer asks of a run of the case: the wave that arrives, how many stones it moves and how far, beside the
start of damage by Hudson and van der Meer. Usage: stones.py RESULTS

A stone has moved when it lies more than one diameter from where it lay when the first wave came (--from, s: by then the
bed has taken up the weight that water leaves it). Writes RESULTS/stones.csv."""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of, write_table  # noqa: E402

G = 9.81
COT = 3.0  # of the slope


def height_of_waves(table, first, last):
    """Mean height from trough to crest between two times, m: of the parts between upward crossings of the mean."""
    time, level = table["time"], table["column_depth"]
    part = (time >= first) & (time <= last)
    if part.sum() < 10:
        return float("nan")
    level = level[part] - np.mean(level[part])
    up = np.flatnonzero((level[:-1] < 0) & (level[1:] >= 0))
    spans = [level[a:b] for a, b in zip(up, up[1:]) if b - a > 5]
    return float(np.mean([np.ptp(span) for span in spans])) if spans else float(np.ptp(level))


def van_der_meer(breaking, permeability=0.1, damage=2, waves=1000):
    """H / (Delta D_n) at the start of damage; `breaking`: the surf similarity."""
    level, slope = (damage / np.sqrt(waves)) ** 0.2, 1 / COT
    limit = (6.2 * permeability**0.31 * np.sqrt(slope)) ** (1 / (permeability + 0.5))
    if breaking < limit:  # plunging
        return 6.2 * permeability**0.18 * level / np.sqrt(breaking)
    return permeability**-0.13 * level * np.sqrt(COT) * breaking**permeability  # surging


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--from", dest="start", type=float, default=1.5, help="s; default 1.5")
    args = parser.parse_args()
    run = Path(args.run)
    case = case_of(run)
    motion = next(body["motion"] for body in case["wall"]["body"] if body["name"] == "paddle")
    grain, period = case["grain"], motion["wave_period"]
    delta = grain["rho"] / case["fluid"]["rho0"] - 1
    nominal = (np.pi / 6) ** (1 / 3) * grain["d"]  # edge of a cube of its volume
    frames = Frames(run / "grains.vtkhdf")
    last = len(frames.times) - 1
    if frames.times[last] <= args.start:
        sys.exit(f"{run}: ends before --from {args.start:g}")
    gauge = Table(run / "probes" / "gauge.csv")
    height = height_of_waves(gauge, 2 * period, frames.times[last])
    number = motion["wave_height"] / delta / nominal
    breaking = (1 / COT) / np.sqrt(motion["wave_height"] / (G * period**2 / 2 / np.pi))  # surf similarity
    waves = max(1.0, (frames.times[last] - 3.5) / period)

    x, y = (frames.by_id(frame, "position").astype(float) for frame in (frames.nearest(args.start), last))
    move = y - x
    width = case["domain"]["max"][1] - case["domain"]["min"][1]
    move[:, 1] -= width * np.round(move[:, 1] / width)
    far = np.linalg.norm(move, axis=1) / grain["d"]
    moved = far > 1
    damage = moved.sum() * np.pi / 6 * grain["d"] ** 3 / 0.6 / width / nominal**2  # eroded area over D_n^2
    run_up = Table(run / "probes" / "run_up.csv")["column_depth"]
    vertical = (np.max(run_up) - run_up[0]) / np.sqrt(1 + COT**2)
    hudson = {kd: (kd * COT) ** (1 / 3) for kd in (1.2, 2.0)}
    meer = van_der_meer(breaking)
    rows = [("wave before the toe, mean height", f"{1000 * height:.0f} mm (made: {1000 * motion['wave_height']:.0f})"),
            ("nominal diameter of a stone", f"{1000 * nominal:.1f} mm"),
            ("stability number H / (Delta D_n)", f"{number:.2f}"),
            ("start of damage, Hudson, K_D = 1.2; 2.0", f"{hudson[1.2]:.2f}; {hudson[2.0]:.2f}"),
            ("start of damage, van der Meer, 1000 waves", f"{meer:.2f} (surf similarity {breaking:.2f})"),
            ("waves on the slope", f"{waves:.0f}"),
            ("stones that moved more than a diameter", f"{moved.sum()} of {len(far)} ({100 * moved.mean():.1f} %)"),
            ("farthest", f"{far.max():.1f} diameters; 99 % below {np.percentile(far, 99):.2f}"),
            ("damage S (moved stones as an area over D_n^2)", f"{damage:.1f}"),
            ("moved stones: up the slope, down the slope", f"{np.sum(moved & (move[:, 2] > 0))}, "
                                                          f"{np.sum(moved & (move[:, 2] <= 0))}"),
            ("run-up above still water", f"{1000 * vertical:.0f} mm")]
    write_table(run / "stones.csv", ["time [s]", "moved [-]", "farthest [-]"],
                [(frames.times[last], moved.mean(), far.max())])
    for what, value in rows:
        print(f"{what:55} {value}")


if __name__ == "__main__":
    main()
