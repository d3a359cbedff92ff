#!/usr/bin/env python3
"""Runs the injection cell at several rates and looks for the lowest at which the jet stirs the bed.

    sweep.py PROGRAM OUT_DIR [--rates 50,100,200,400,600] [-- --set fluid.dx=0.0005 ...]

Each run lasts until 1.2 times the time that the rate takes to fill the voids of the bed, as in the case at
100 ml/min, and leaves 85 frames. Runs that OUT_DIR holds already are not repeated. What follows -- goes to the
program. Prints a table; a bed is stirred if its grains have moved half a diameter on average before it is immersed.
"""

import argparse
import subprocess
from pathlib import Path

from measure import report

END = 1.7 * 100  # s ml/min
FRAMES = 85


def run(program, folder, rate, further):
    end = END / rate
    subprocess.run([program, "run", Path(__file__).parent / "case.toml", "--out", folder,
                    "--set", f"inlet.0.rate={rate / 6e7:.9g}", "--set", f"time.end={end:.6g}",
                    "--set", f"out.every={end / FRAMES:.6g}",
                    "--set", f"out.diagnostics_every={end / FRAMES / 2:.6g}", *further], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("out")
    parser.add_argument("--rates", default="50,100,200,400,600", help="ml/min; default %(default)s")
    parser.add_argument("further", nargs="*", help="options of the program, after --")
    args = parser.parse_args()

    print("ml/min  immersed (s)  through (s)  highest (mm)  moved before (mm)", flush=True)
    stirred = []
    for rate in sorted(float(text) for text in args.rates.split(",")):
        folder = Path(args.out) / f"{rate:g}"
        if not (folder / "summary.json").exists():
            run(args.program, folder, rate, args.further)
        it = report(folder)
        print(f"{rate:6g}  {it['immersion']:12.3f}  {it['breakthrough']:11.3f}  {1e3 * it['jet']:12.1f}"
              f"  {1e3 * it['moved']:17.2f}", flush=True)
        if it["moved"] > it["diameter"] / 2:
            stirred.append(rate)
    print(f"lowest rate that stirs the bed: {min(stirred):g} ml/min" if stirred else "no rate stirs the bed")


if __name__ == "__main__":
    main()
