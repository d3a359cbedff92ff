#!/usr/bin/env python3
"""Relative viscosity over concentration: what was measured, and what laws of resolved spheres say.

    plot.py PNG [measured.csv]
"""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

HERE = Path(__file__).resolve().parent
LAWS = {"einstein": "Einstein", "batchelor": "Batchelor", "krieger_dougherty": "Krieger-Dougherty"}


def columns(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def main():
    measured = columns(Path(sys.argv[2]) if len(sys.argv) > 2 else HERE / "measured.csv")
    laws = columns(HERE / "reference.csv")
    figure, axes = plt.subplots(figsize=(6, 4))
    for name, label in LAWS.items():
        axes.plot(laws["phi"], laws[name], label=label)
    axes.plot(measured["phi"], measured["by_force"], "ko", label="by the force that acts")
    axes.plot(measured["phi"], measured["with_lubrication"], "rx", label="the same with lubrication")
    as_in_paper = "by the force on pure fluid, as in the paper"
    axes.plot(measured["phi"], measured["as_in_paper"], "s", mfc="none", label=as_in_paper)
    axes.set(xlabel="volume of grains over that of all (-)", ylabel="relative viscosity (-)")
    axes.set(xlim=(0, 0.12), ylim=(0.9, 1.5))
    axes.legend(frameon=False, fontsize="small", loc="upper left")
    figure.tight_layout()
    figure.savefig(sys.argv[1], dpi=120)


if __name__ == "__main__":
    main()
