#!/usr/bin/env python3
"""Power draw of the mill, against the balance of moments about its axis.

    power.py RUN_DIR [START]

The torque of the mill on the charge, mean from START on (s, default 0.8, when the charge circulates), is the work of the
walls over the angle; with slurry it is minus the torque that the force probe "mill" has measured. By the balance of
moments it is that of the weight about the axis, m g <x>, and the gain of angular momentum; both follow from other columns
of diagnostics.csv. The residual of the energy balance of the grains is over what contacts dissipate and slurry takes.
Writes RUN_DIR/power.csv and prints it.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Table, case_of, write_table  # noqa: E402

NAMES = ["time [s]", "power [W]", "torque [N m]", "balance [N m]", "ratio [-]", "dissipated [W]", "residual [-]"]


def mean_torque(run, start, end):
    """On the mill, between two rows of its probe: each row has the mean since the one before."""
    probe = Table(run / "probes" / "mill.csv")
    t, torque = probe["time"], probe["torque_total_y"]
    since = (t[1:] > start) & (t[1:] <= end)
    return np.sum((torque[1:] * np.diff(t))[since]) / (end - start)


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

    slurry = "fluid" in case and case["fluid"].get("present", True)
    parts = ["grain", "fluid"] if slurry else ["grain"]
    moment = case["gravity"][2] * sum(d[f"{part}_mass"] * d[f"{part}_centre_x"] for part in parts)[late]
    gained = sum(gain(f"{part}_angular_momentum_y") for part in parts)
    balance = (np.sum(0.5 * (moment[1:] + moment[:-1]) * np.diff(t)) + gained) / span  # the mill turns z to x
    lost = sum(gain(f"grain_dissipated_{kind}") for kind in ("normal", "sliding", "rolling"))
    torque = -mean_torque(run, t[0], t[-1]) if slurry else gain("grain_work_walls") / (rate * span)
    taken = lost + abs(gain("grain_work_fluid")) if slurry else lost
    return [t[-1], torque * rate, torque, balance, torque / balance, lost / span, gain("grain_energy_residual") / taken]


def main():
    run, start = Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 0.8
    values = row(run, start)
    write_table(run / "power.csv", NAMES, [values])
    for name, value in zip(NAMES, values):
        print(f"{name:16} {value:.6g}")


if __name__ == "__main__":
    main()
