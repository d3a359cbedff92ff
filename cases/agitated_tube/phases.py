#!/usr/bin/env python3
"""Motion of the agitator through one period of the shaking, and the water at its five phases.

    phases.py RUN_DIR [--period N]

Writes RUN_DIR/periods.csv (top speed of the agitator in each period), RUN_DIR/phases.csv (phase and speed of the five
events of He et al. (2018), Fig. 10: A and E highest, C lowest, B and D half-way down and up between them; the paper
does not say what its B and D are) and RUN_DIR/phases.png: height and speed of the agitator over the period, and the
speed of the water at the five phases, across the tube and seen from above along its axis. Takes the last whole
period, or number N from 1. Needs frames of that period (out.every of a twentieth of it or less) for the water.
"""

import argparse
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of, write_table  # noqa: E402

PAPER = {"A": 0.581, "B": 0.906, "C": 1.150, "D": 1.393, "E": 1.637}  # pi


def events(phase, z, speed):
    """Phase (pi) and speed (m/s) of A..E within one period that begins as the tube passes its middle."""
    lowest = next(k for k in np.argsort(z) if 0.75 < phase[k] < 1.6)
    first, second = np.arange(lowest), np.arange(lowest, len(z))
    a, e = first[np.argmax(z[first])], second[np.argmax(z[second])]
    def half_way(begin, end):
        return begin + np.argmin(np.abs(z[begin:end + 1] - (z[begin] + z[end]) / 2))

    at = {"A": a, "B": half_way(a, lowest), "C": lowest, "D": half_way(lowest, e), "E": e}
    return {name: (phase[at[name]], speed[at[name]]) for name in PAPER}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--period", type=int)
    args = parser.parse_args()
    run = Path(args.run)
    case = case_of(run)
    f = case["frame"]["motion"]["frequency"]
    table = Table(run / "bodies" / "agitator.csv")
    t, y, z = (table.column(name) for name in ("time", "centre_y", "centre_z"))
    speed = np.hypot(table.column("velocity_y"), table.column("velocity_z"))
    whole = int(t[-1] * f + 1e-9)
    number = whole if args.period is None else args.period
    if not 1 <= number <= whole:
        raise SystemExit(f"{run}: holds {whole} whole periods, not number {number}")
    tops = []
    for n in range(1, whole + 1):
        part = (t >= (n - 1) / f) & (t <= n / f)
        tops.append([f"{n / f:.4f}", f"{speed[part].max():.5f}"])
        print(f"period {n}: top speed {speed[part].max():.4f} m/s")
    write_table(run / "periods.csv", ["time [s]", "top_speed [m/s]"], tops)
    part = (t >= (number - 1) / f) & (t <= number / f)
    phase = 2 * (t[part] * f - (number - 1))
    found = events(phase, z[part], speed[part])
    rows = []
    for name, (at, v) in found.items():
        print(f"{name}: {at:.3f} pi, {PAPER[name]} pi in the paper; {v:.4f} m/s")
        numbers = (number - 1 + at / 2) / f, at, PAPER[name], at - PAPER[name], v
        rows.append([*(f"{x:.4f}" for x in numbers), name])
    names = ["time [s]", "phase [pi]", "paper [pi]", "difference [pi]", "speed [m/s]", "event"]
    write_table(run / "phases.csv", names, rows)
    draw(run, case, phase, y[part], z[part], speed[part], found, (number - 1) / f, f)


def draw(run, case, phase, y, z, speed, found, begin, f):
    figure, axes = plt.subplots(3, 5, figsize=(17, 9), layout="constrained")
    grid = axes[0, 0].get_gridspec()
    for axis in axes[0]:
        axis.remove()
    place, pace = figure.add_subplot(grid[0, :2]), figure.add_subplot(grid[0, 2:])
    for values, label in ((1000 * y, "y"), (1000 * z, "z")):
        place.plot(phase, values, label=label)
    place.set_ylabel("place of the agitator (mm)")
    place.legend()
    pace.plot(phase, speed)
    pace.set_ylabel("speed of the agitator (m/s)")
    for axis in (place, pace):
        axis.set_xlabel("phase of the shaking (pi)")
        for name, (at, _) in found.items():
            axis.axvline(at, color="#999999", lw=0.8)
            axis.text(at, axis.get_ylim()[1], name, ha="center", va="bottom")
    water = Frames(run / "fluid.vtkhdf")
    span = [(1000 * low, 1000 * high) for low, high in zip(case["domain"]["min"], case["domain"]["max"])]
    for k, (name, (at, _)) in enumerate(found.items()):
        wanted = begin + at / 2 / f
        frame = water.nearest(wanted)
        if abs(water.times[frame] - wanted) > 0.025 / f:
            raise SystemExit(f"{run}: frames too far apart for t = {wanted:.3f} s; run with "
                             f"--set out.every={0.04 / f:.2g}")
        x = 1000 * water.position(frame)
        v = np.linalg.norm(water.get(frame, "velocity"), axis=1)
        middle = (x[:, 0].max() + x[:, 0].min()) / 2
        slab = np.abs(x[:, 0] - middle) < 0.05 * np.ptp(x[:, 0])
        top = surface(x, 750 * case["fluid"]["dx"])
        for axis, pick, (a, b) in ((axes[1, k], slab, (1, 2)), (axes[2, k], top, (0, 1))):
            order = np.flatnonzero(pick)
            shown = axis.scatter(x[order, a], x[order, b], c=v[order], s=4, vmin=0, vmax=0.3, cmap="viridis", lw=0)
            axis.set_aspect("equal")
            axis.set_xlim(*span[a])
            axis.set_ylim(*span[b])
            axis.set_xlabel("xyz"[a] + " (mm)")
        axes[1, k].set_title(f"{name}, t = {water.times[frame]:.3f} s")
    axes[1, 0].set_ylabel("z (mm)")
    axes[2, 0].set_ylabel("y (mm), free surface")
    figure.colorbar(shown, ax=axes[1:, :], label="speed of the water (m/s)")
    figure.savefig(run / "phases.png", dpi=110)


def surface(x, cell):
    """Which particles (places in mm) lie highest above their place in plan, to within a cell."""
    column = np.floor(x[:, :2] / cell).astype(int)
    column -= column.min(axis=0)
    key = column[:, 0] * (column[:, 1].max() + 1) + column[:, 1]
    top = np.full(key.max() + 1, -np.inf)
    np.maximum.at(top, key, x[:, 2])
    return x[:, 2] > top[key] - cell


if __name__ == "__main__":
    main()
