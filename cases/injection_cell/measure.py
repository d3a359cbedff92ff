#!/usr/bin/env python3
"""Grains, water level and jet of a run of the injection cell.

    measure.py RUN_DIR

Writes RUN_DIR/cell.csv and RUN_DIR/cell.png, a row for each frame, and prints what came out. The cell is seen as
columns 1.5 mm wide. The level is the median of the columns' highest water, a dry one counting as empty, and
its spread the mean absolute deviation from that; the jet is the highest water within 2 mm of the axis. The bed is
immersed when the level has come up to its top at t = 0, and the jet breaks through when it is higher than that while
the bed is not immersed. Displacements are from t = 0, `before_immersion` up to the immersion.
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

COLUMN = 1.5e-3  # m
AXIS = 2e-3  # m


class Cell:
    """What the case says of the cell, and the columns that it is seen as."""

    def __init__(self, run):
        case = case_of(run)
        inside = next(shape for shape in case["shape"] if shape["name"] == "inside")
        inlet = case["inlet"][0]
        self.radius, self.dx = inside["radius"], case["fluid"]["dx"]
        self.rate, self.rho, self.d = inlet["rate"], case["fluid"]["rho0"], case["grain"]["d"]
        self.across = int(np.ceil(2 * self.radius / COLUMN))
        middle = (np.arange(self.across) + 0.5) * COLUMN - self.radius
        self.within = np.hypot(*np.meshgrid(middle, middle)).ravel() < self.radius - COLUMN / 2

    def tops(self, x, above):
        """Highest place of points [n, 3] in each column, and `above` them, m; 0 in an empty one."""
        k = np.floor((x[:, :2] + self.radius) / COLUMN).astype(int).clip(0, self.across - 1)
        top = np.zeros(self.across**2)
        np.maximum.at(top, k[:, 1] * self.across + k[:, 0], x[:, 2] + above)
        return top[self.within]


def measure(run):
    """The rows of cell.csv as columns by name, and the immersion time (s, nan if there was none)."""
    cell = Cell(run)
    water, grains = Frames(run / "fluid.vtkhdf"), Frames(run / "grains.vtkhdf")
    places = [grains.position(k)[np.argsort(grains.get(k, "id"))] for k in range(len(grains.times))]
    bed = float(np.median(cell.tops(places[0], cell.d / 2)))
    rows = {name: [] for name in ("level", "level_spread", "jet_height", "mean_displacement",
                                  "largest_displacement")}
    for k in range(len(grains.times)):
        x = water.position(k)
        tops = cell.tops(x, cell.dx / 2)
        near = x[np.hypot(x[:, 0], x[:, 1]) < AXIS, 2]
        moved = np.linalg.norm(places[k] - places[0], axis=1)
        rows["level"].append(np.median(tops))
        rows["level_spread"].append(np.mean(np.abs(tops - np.median(tops))))
        rows["jet_height"].append(near.max() + cell.dx / 2 if len(near) else 0.0)
        rows["mean_displacement"].append(moved.mean())
        rows["largest_displacement"].append(moved.max())
    rows = {"time": grains.times, **{name: np.array(values) for name, values in rows.items()}}
    immersed = rows["level"] >= bed
    first = int(np.argmax(immersed)) if immersed.any() else len(immersed)
    rows["before_immersion"] = rows["mean_displacement"][np.minimum(np.arange(len(immersed)), first)]

    table = Table(run / "diagnostics.csv")
    column = {name: np.interp(rows["time"], table.column("time"), table.column(name))
              for name in ("fluid_mass", "lost_fluid_mass", "outlet_top_fluid_mass", "inlet_jet_volume")}
    rows["injected_mass"] = column["fluid_mass"] + column["lost_fluid_mass"] + column["outlet_top_fluid_mass"]
    rows["wanted_mass"] = cell.rho * column["inlet_jet_volume"]
    return cell, bed, rows, rows["time"][first] if first < len(immersed) else np.nan


UNITS = {"time": "s", "injected_mass": "kg", "wanted_mass": "kg"}


def write(run, rows):
    names = [f"{name} [{UNITS.get(name, 'm')}]" for name in rows]
    write_table(run / "cell.csv", names, np.transpose(list(rows.values())).tolist())


def draw(run, cell, bed, rows, immersion):
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for name in ("level", "jet_height"):
        axes[0].plot(rows["time"], 1e3 * rows[name], label=name.replace("_", " "))
    axes[0].axhline(1e3 * bed, color="grey", ls=":", label="bed at t = 0")
    axes[0].set_ylabel("height (mm)")
    axes[1].plot(rows["time"], 1e3 * rows["mean_displacement"], label="mean displacement of grains")
    axes[1].axhline(500 * cell.d, color="grey", ls=":", label="half a diameter")
    axes[1].set_ylabel("displacement (mm)")
    for axis in axes:
        if np.isfinite(immersion):
            axis.axvline(immersion, color="tab:red", lw=0.8, label="immersed")
        axis.set_xlabel("t (s)")
        axis.legend(fontsize=8)
    figure.suptitle(f"{6e7 * cell.rate:.0f} ml/min")
    figure.savefig(run / "cell.png", dpi=120)


def report(run):
    """Measures a run, leaves cell.csv and cell.png in it; returns a dict of numbers, SI."""
    cell, bed, rows, immersion = measure(run)
    write(run, rows)
    draw(run, cell, bed, rows, immersion)
    through = (rows["jet_height"] > bed + cell.d) & (rows["level"] < bed)
    broke = rows["time"][np.argmax(through)] if through.any() else np.nan
    return {"rate": cell.rate, "bed": bed, "immersion": immersion, "breakthrough": broke,
            "moved": rows["before_immersion"][-1], "diameter": cell.d, "jet": rows["jet_height"].max(),
            "end": rows["time"][-1]}


def after(time):
    return "never" if np.isnan(time) else f"after {time:.3f} s"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    it = report(Path(parser.parse_args().run))
    if np.isnan(it["immersion"]):
        print(f"not immersed by {it['end']:.3g} s; displacements are those of the whole run")
    print(f"rate                {6e7 * it['rate']:.0f} ml/min")
    print(f"bed                 {1e3 * it['bed']:.1f} mm high")
    print(f"immersed            {after(it['immersion'])}")
    print(f"jet breaks through  {after(it['breakthrough'])}; highest {1e3 * it['jet']:.1f} mm")
    print(f"grains moved        {1e3 * it['moved']:.2f} mm on average before it was immersed, "
          f"{it['moved'] / it['diameter']:.2f} diameters")


if __name__ == "__main__":
    main()
