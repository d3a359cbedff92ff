#!/usr/bin/env python3
"""Power draw of the mill by turns, against the balance of moments about its axis.

    power.py RUN_DIR

The torque of the mill on the charge, mean over a turn, is the work of the walls over the angle. By the balance of
moments it is that of the weight about the axis, m g <x>, and the gain of angular momentum; both follow from other
columns of diagnostics.csv. Writes RUN_DIR/power.csv, a row at the end of each turn after the first, and prints it.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Table, case_of, write_table  # noqa: E402

NAMES = ["time [s]", "power [W]", "torque [N m]", "balance [N m]", "ratio [-]", "dissipated [W]", "residual [-]"]


def rows(run):
    case, d = case_of(run), Table(run / "diagnostics.csv")
    rate = next(body["motion"]["rate"] for body in case["wall"]["body"] if body["name"] == "mill")
    weight = -case["gravity"][2]
    t = d["time"]
    turn = 2 * np.pi / rate
    moment = -weight * d["grain_mass"] * d["grain_centre_x"]  # that the mill has to balance; it turns z to x
    lost = sum(d[f"grain_dissipated_{kind}"] for kind in ("normal", "sliding", "rolling"))
    for n in range(1, int(t[-1] / turn + 1e-9)):
        first, last = (int(np.argmin(abs(t - k * turn))) for k in (n, n + 1))
        span, part = t[last] - t[first], slice(first, last + 1)

        def gain(y):
            return y[last] - y[first]

        work = gain(d["grain_work_walls"])
        torque = work / (rate * span)
        mean = np.sum(0.5 * (moment[part][1:] + moment[part][:-1]) * np.diff(t[part])) / span
        balance = mean + gain(d["grain_angular_momentum_y"]) / span
        residual = gain(d["grain_energy_residual"]) / gain(lost)
        yield [t[last], work / span, torque, balance, torque / balance, gain(lost) / span, residual]


def main():
    run = Path(sys.argv[1])
    table = list(rows(run))
    write_table(run / "power.csv", NAMES, table)
    print("  ".join(f"{name:>14}" for name in NAMES))
    for row in table:
        print("  ".join(f"{value:14.6g}" for value in row))


if __name__ == "__main__":
    main()
