#!/usr/bin/env python3
"""Energy balance of the rolled tank: work of the tank on the water, energy of the water, and what is missing.

    energy_balance.py RUN...

RUN is a folder of results. The work is that of the tank's torque about its axis, by trapezes over the readings of the
probe. What is missing has gone into heat or is an error of the scheme: it must never fall. Prints joules, and writes
RUN/energy.csv.
"""

import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Table, write_table  # noqa: E402

AMPLITUDE, PERIOD, RAMP = math.radians(2), 1.6, 2.0  # of `rotation` in case.toml


def angular_velocity(t):
    w, grown = 2 * math.pi / PERIOD, 1 - math.exp(-RAMP * t)
    return AMPLITUDE * (RAMP * math.exp(-RAMP * t) * math.sin(w * t) + grown * w * math.cos(w * t))


def balance(run):
    """Times, work and energy gained since the start."""
    tank, diagnostics = Table(run / "probes" / "tank.csv"), Table(run / "diagnostics.csv")
    t, torque = tank.column("time"), tank.column("torque_by_fluid_y")
    work = [0.0]
    power = [-m * angular_velocity(time) for time, m in zip(t, torque)]
    for k in range(1, len(t)):
        work.append(work[-1] + 0.5 * (t[k] - t[k - 1]) * (power[k] + power[k - 1]))
    energies = [diagnostics.column(name) for name in ("time", "fluid_kinetic_energy", "fluid_potential_energy",
                                                      "fluid_elastic_energy")]
    out, k = [], 0
    for time, *parts in zip(*energies):
        while k + 1 < len(t) and t[k] < time - 1e-6:
            k += 1
        out.append((time, work[k], sum(parts)))
    return [(time, w, e - out[0][2]) for time, w, e in out]


def main():
    for run in map(Path, sys.argv[1:]):
        rows = balance(run)
        missing = [w - e for _, w, e in rows]
        write_table(run / "energy.csv", ["time [s]", "work [J]", "energy [J]", "missing [J]"],
                    [[*row, m] for row, m in zip(rows, missing)])
        highest, fall = missing[0], 0.0
        for m in missing:
            highest = max(highest, m)
            fall = max(fall, highest - m)
        _, work, energy = rows[-1]
        print(f"{run}: work {work:.4f} J, energy gained {energy:.4f} J, missing {missing[-1]:.4f} J; "
              f"what is missing falls by at most {fall:.4f} J on the way")


if __name__ == "__main__":
    main()
