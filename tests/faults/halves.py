#!/usr/bin/env python3
"""Every shipped case, a few steps of it, unbroken and in two halves: the end must be the same, byte for byte.

    halves.py BEDLOAD [--only NAME ...] [--steps 24] [--backend cpu] [--threads 2 1 3] [--settle]

BEDLOAD is the program. The second half goes on from the checkpoint that the first leaves; the whole and either half
run on different numbers of threads. Beds are as initialised unless --settle is given, which some cases take minutes for. Prints a line for each case; exits with 1 if one differs or fails.
Not part of the test suite.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

CASES = Path(__file__).resolve().parents[2] / "cases"


def last_checkpoint(run):
    return sorted((run / "checkpoints").glob("step_*.h5"))[-1]


def halves(case, options, folder):
    """What became of a case, and whether that is as it should be."""
    settings = ["--backend", options.backend]
    if not options.settle:
        settings += ["--set", "grain.settle=false"] if "settle = true" in case.read_text() else []

    def run(name, threads, *arguments):
        done = subprocess.run([options.program, "run", case, "--out", folder / name, "--quiet", *settings, "--threads",
                               str(threads), *arguments], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"ended with {done.returncode}: {done.stderr.strip().splitlines()[-1:]}")
        return json.loads((folder / name / "summary.json").read_text())

    try:
        of_whole, of_first, of_second = options.threads
        first = run("trial", of_whole, "--until", "1e-12")  # one step
        end = options.steps * first["time"]["value"]
        whole = run("whole", of_whole, "--until", repr(end))
        run("halves", of_first, "--until", repr(0.5 * end))
        run("halves", of_second, "--until", repr(end), "--restart", "latest")
    except RuntimeError as error:
        return str(error), False
    a, b = last_checkpoint(folder / "whole"), last_checkpoint(folder / "halves")
    same = a.name == b.name and a.read_bytes() == b.read_bytes()
    return f"{whole['steps']} steps, " + ("the same bytes" if same else f"{a.name} and {b.name} differ"), same


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--only", nargs="*", default=[], help="names of cases or their folders")
    parser.add_argument("--steps", type=int, default=24, help="of the first step's length")
    parser.add_argument("--backend", default="cpu")
    parser.add_argument("--threads", type=int, nargs=3, default=[2, 1, 3], help="of the whole and of either half")
    parser.add_argument("--settle", action="store_true", help="beds settle first, as the cases have it")
    options = parser.parse_args()
    options.program = options.program.resolve()

    wrong = 0
    for case in sorted(CASES.glob("*/*.toml")):
        if case.name.startswith("expect"):
            continue
        if options.only and case.stem not in options.only and case.parent.name not in options.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            text, well = halves(case, options, Path(folder))
        wrong += not well
        print(f"{case.relative_to(CASES)}: {text}", flush=True)
    sys.exit(wrong > 0)


if __name__ == "__main__":
    main()
