#!/usr/bin/env python3
"""What an engineer asks of runs of the case: power, how many grains are lifted, and the just-suspended speed.
Usage: suspension.py RESULTS [RESULTS ...] [--start S]

With several runs at other speeds: the speed at which 2 % of the grains are left on the floor, between the two runs
about it. Means are taken from `start` on."""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of  # noqa: E402
from bedload.measures import power_number  # noqa: E402

G, D, T = 9.81, 0.1, 0.2  # m/s2; diameters of impeller and tank, m
LEFT = 0.02  # of the grains on the floor: just suspended


def zwietering(s, case, mass):
    """N_js = S nu^0.1 d^0.2 (g (rho_s - rho) / rho)^0.45 X^0.13 / D^0.85, 1/s; X: mass of solids in % of the liquid."""
    rho, grain = case["fluid"]["rho0"], case["grain"]
    liquid = rho * np.pi / 4 * T**3
    lift = G * (grain["rho"] / rho - 1)
    return s * (case["fluid"]["mu"] / rho)**0.1 * grain["d"]**0.2 * lift**0.45 * (100 * mass / liquid)**0.13 / D**0.85


def measured(run, start):
    """Speed 1/s, power W, power number, case, mass of grains kg, fractions of them on the floor, in the upper half."""
    case = case_of(run)
    probe = {path.stem: Table(path) for path in Path(run).glob("probes/*.csv")}
    if probe["impeller"]["time"][-1] <= start:
        sys.exit(f"{run}: ends before --start {start:g}")
    mean = lambda table, column: float(np.mean(table[column][table["time"] >= start]))  # noqa: E731
    omega = next(body for body in case["wall"]["body"] if body["name"] == "impeller")["motion"]["rate"]
    power = -mean(probe["impeller"], "torque_total_z") * omega
    frames = Frames(Path(run) / "grains.vtkhdf")
    count = len(frames.position(len(frames.times) - 1))
    turns = omega / (2 * np.pi)
    mass = count * case["grain"]["rho"] * np.pi / 6 * case["grain"]["d"]**3
    return (turns, power, power_number(power, case["fluid"]["rho0"], turns, D), case, mass,
            mean(probe["floor"], "count") / count, mean(probe["upper_half"], "count") / count)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", nargs="+")
    parser.add_argument("--start", type=float, default=0.7, help="s; default 0.7")
    args = parser.parse_args()
    runs = sorted((measured(run, args.start) for run in args.run), key=lambda r: r[0])
    for turns, power, number, _, _, floor, upper in runs:
        print(f"{60 * turns:6.0f} rpm  power {1000 * power:7.1f} mW  power number {number:5.2f}  "
              f"on the floor {100 * floor:5.1f} %  in the upper half {100 * upper:5.1f} %")
    for s in (4.0, 5.5, 7.0):
        print(f"Zwietering, S = {s:g}: {60 * zwietering(s, runs[0][3], runs[0][4]):.0f} rpm")
    for slow, fast in zip(runs, runs[1:]):
        if slow[5] > LEFT >= fast[5]:
            at = np.interp(np.log(LEFT), np.log([max(fast[5], 1e-4), slow[5]]), [fast[0], slow[0]])
            print(f"just suspended ({100 * LEFT:g} % on the floor): {60 * at:.0f} rpm")


if __name__ == "__main__":
    main()
