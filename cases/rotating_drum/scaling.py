#!/usr/bin/env python3
"""Time a step takes in drums of 100, 200, 300 and 400 mm, and how it grows with the number of particles.

    scaling.py PROGRAM OUT_DIR [--until S] [--settle S]

Runs each drum for `until` seconds after its beads have settled for `settle`, tells milliseconds a step of the fluid, of
the grains, of their coupling and of the lists, and fits lines a + b N: of the fluid over the number of SPH particles,
walls included, of a grain substep over the number of grains. Writes OUT_DIR/scaling.csv.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import write_table  # noqa: E402
from runs import run_case  # noqa: E402

CASE = Path(__file__).resolve().parent / "case.toml"
GRAINS = 7755
PARTS = ("fluid", "grains", "coupling", "lists", "checks")


def run(program, out, scale, until, settle):
    edge = 0.05 * scale + 0.02
    settings = {
        "shape.0.scale": scale,
        "grain.fill.0.count": GRAINS * scale**3,
        "domain.min": [-edge] * 3,
        "domain.max": [edge] * 3,
        "grain.settle_time": settle,
        "out.every": 1,
    }
    summary = run_case(program, CASE, out, settings, "--overwrite", "--quiet", "--until", until)
    parts = [1000 * summary["wall_time_of"][part]["value"] / summary["steps"] for part in PARTS]
    counts = summary["counts"]
    return [100 * scale, counts["fluid"], counts["walls"], counts["grains"], summary["steps"],
            summary["substeps"] / summary["steps"], *parts]


def fit(what, n, ms):
    slope, offset = np.polyfit(n, ms, 1)
    off = ms - (offset + slope * n)
    r2 = 1 - (off**2).sum() / ((ms - ms.mean()) ** 2).sum()
    print(f"{what}: {offset:.3g} ms + {1e6 * slope:.4g} ns N, R2 = {r2:.4f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("--until", type=float, default=0.03)
    parser.add_argument("--settle", type=float, default=0.05)
    args = parser.parse_args()
    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    names = ["drum [mm]", "fluid", "walls", "grains", "steps", "substeps a step", *(f"{p} [ms/step]" for p in PARTS)]
    rows = []
    for scale in (1, 2, 3, 4):
        rows.append(run(args.program, out / f"drum_{100 * scale}", scale, args.until, args.settle))
        print("  ".join(f"{name} {value:.4g}" for name, value in zip(names, rows[-1])), flush=True)
    write_table(out / "scaling.csv", names, rows)
    table = np.array(rows, dtype=float)
    fit("fluid, a step", table[:, 1] + table[:, 2], table[:, 6])
    fit("grains, a substep", table[:, 3], table[:, 7] / table[:, 5])


if __name__ == "__main__":
    main()
