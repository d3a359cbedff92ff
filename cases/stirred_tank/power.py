#!/usr/bin/env python3
"""Torque, power and power number of the impeller.

    power.py RUN_DIR [--start S] [--diameter M]

Averages probes/impeller.csv from `start` on. The torque is what the impeller exerts on the water about z, N m;
the power P = T omega, W; the power number P / (rho N^3 D^5) and the Reynolds number rho N D^2 / mu are pure
numbers. The speed is that of the last instant, from frames of the walls.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of  # noqa: E402
from bedload.measures import angular_velocity, power_number  # noqa: E402


def speed(run, body):
    """Angular velocity about z of a wall body in the last frame, rad/s."""
    walls = Frames(run / "walls.vtkhdf")
    frame = len(walls.times) - 1
    own = walls.get(frame, "body") == body
    return float(angular_velocity(walls.position(frame)[own], walls.get(frame, "velocity")[own])[2])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--start", type=float, default=1.0, help="s; default 1")
    parser.add_argument("--diameter", type=float, default=0.05, help="of the impeller, m; default 0.05")
    args = parser.parse_args()

    run = Path(args.run)
    case = case_of(run)
    bodies = [body["name"] for body in case["wall"]["body"]]
    omega = speed(run, bodies.index("impeller"))
    table = Table(run / "probes" / "impeller.csv")
    time, torque = table.column("time"), -table.column("torque_by_fluid_z")
    if time[-1] <= args.start:
        raise SystemExit(f"{run}: ends at {time[-1]:g} s, before --start {args.start:g}")
    torque = torque[time >= args.start]
    rho, mu, turns = case["fluid"]["rho0"], case["fluid"]["mu"], omega / (2 * np.pi)
    power = torque.mean() * omega
    print(f"speed            {omega:.3f} rad/s, {turns:.3f} turns/s")
    print(f"torque           {1e3 * torque.mean():.4g} mN m, standard deviation {1e3 * torque.std():.2g} mN m")
    print(f"power            {1e3 * power:.4g} mW")
    print(f"Reynolds number  {rho * turns * args.diameter**2 / mu:.4g}")
    print(f"power number     {power_number(power, rho, turns, args.diameter):.3g}")


if __name__ == "__main__":
    main()
