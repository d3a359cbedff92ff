#!/usr/bin/env python3
"""Runs the injection cell at several rates and looks for the lowest at which the jet stirs the bed.

    sweep.py PROGRAM OUT_DIR [--case coarse.toml] [--rates 50,100,200,400,600] [-- --set fluid.c_factor=5 ...]

Each run lasts until 1.2 times the time that the rate takes to fill the voids of the bed, as in the cases, and leaves
85 frames. Runs that OUT_DIR holds completed are not repeated, interrupted ones go on. What follows -- goes to the
program. Prints a table; a bed is stirred if its grains have moved half a diameter on average before it is immersed.
"""

import argparse
import math
import sys
from pathlib import Path

from measure import report

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
import frames  # noqa: E402, F401  finds the package
from bedload.sweeps import sweep  # noqa: E402

END = 1.7 * 100  # s ml/min
FRAMES = 85
HERE = Path(__file__).parent


def settings(rate):
    """Values of keys for a rate in ml/min."""
    end = END / rate
    values = {"inlet.0.rate": rate / 6e7, "time.end": end, "out.every": end / FRAMES,
              "out.diagnostics_every": end / FRAMES / 2}
    return {key: float(f"{value:.9g}") for key, value in values.items()}


def rates(text):
    """Numbers (ml/min) of a list with commas, lowest first."""
    try:
        values = sorted(float(word) for word in text.split(","))
    except ValueError:
        values = []
    if not values or not all(0 < value < math.inf for value in values):
        raise argparse.ArgumentTypeError(f"'{text}' must be numbers above 0 ml/min with commas between them")
    return values


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("--case", default="case.toml", help="beside this file; default %(default)s")
    parser.add_argument("--rates", type=rates, default="50,100,200,400,600", help="ml/min; default %(default)s")
    cut = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    args, further = parser.parse_args(sys.argv[1:cut]), sys.argv[cut + 1:]

    done = sweep(HERE / args.case, [settings(rate) for rate in args.rates], args.out, program=args.program,
                 options=further, name=lambda values: f"{values['inlet.0.rate'] * 6e7:g}",
                 tell=lambda point: print(f"{point.folder}: {point.status} {point.message}", flush=True))
    if done.failed:
        raise SystemExit(f"{len(done.failed)} of {len(done)} runs have not completed")
    print("ml/min  immersed (s)  through (s)  highest (mm)  moved before (mm)")
    stirred = []
    for rate, point in zip(args.rates, done):
        it = report(point.folder)
        immersed, through = (f"{it[name]:.3f}".replace("nan", "never") for name in ("immersion", "breakthrough"))
        print(f"{rate:6g}  {immersed:>12}  {through:>11}  {1e3 * it['jet']:12.1f}"
              f"  {1e3 * it['moved']:17.2f}")
        if it["moved"] > it["diameter"] / 2:
            stirred.append(rate)
    print(f"lowest rate that stirs the bed: {min(stirred):g} ml/min" if stirred else "no rate stirs the bed")


if __name__ == "__main__":
    main()
