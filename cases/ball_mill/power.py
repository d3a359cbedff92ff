#!/usr/bin/env python3
"""Power draw of the mill, against the balance of moments about its axis.

    power.py RUN_DIR [START]

The torque of the mill on the charge, mean from START on (s, default 0.8, when the charge circulates), is the work of the
walls over the angle. By the balance of moments it is that of the weight about the axis, m g <x>, and the gain of angular
momentum; both follow from other columns of diagnostics.csv. Writes RUN_DIR/power.csv and prints it.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Table, case_of, write_table  # noqa: E402

NAMES = ["time [s]", "power [W]", "torque [N m]", "balance [N m]", "ratio [-]", "dissipated [W]", "residual [-]"]


def row(run, start):
    case, d = case_of(run), Table(run / "diagnostics.csv")
    rate = next(body["motion"]["rate"] for body in case["wall"]["body"] if body["name"] == "mill")
    t = d["time"]
    late = t >= start
    t = t[late]
    span = t[-1] - t[0]

    def gain(name):
        y = d[name][late]
        return y[-1] - y[0]

    moment = case["gravity"][2] * (d["grain_mass"] * d["grain_centre_x"])[late]  # that the mill balances: it turns z to x
    balance = np.sum(0.5 * (moment[1:] + moment[:-1]) * np.diff(t)) / span + gain("grain_angular_momentum_y") / span
    lost = sum(gain(f"grain_dissipated_{kind}") for kind in ("normal", "sliding", "rolling"))
    torque = gain("grain_work_walls") / (rate * span)
    return [t[-1], torque * rate, torque, balance, torque / balance, lost / span, gain("grain_energy_residual") / lost]


def main():
    run, start = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 0.8
    values = row(run, start)
    write_table(run / "power.csv", NAMES, [values])
    for name, value in zip(NAMES, values):
        print(f"{name:16} {value:.6g}")


if __name__ == "__main__":
    main()
