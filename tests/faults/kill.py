#!/usr/bin/env python3
"""Kills runs at random moments, goes on from the newest checkpoint, each fourth time from any that is there, and compares
the end with that of an unbroken run.

    kill.py BEDLOAD [--kills 200] [--writing 50] [--seed 1]

BEDLOAD is the program. `--writing` of the kills come while a checkpoint is being written. Prints a line for each run that
has come to its end; exits with 1 if one ends with other bytes in its last checkpoint or a table, or a checkpoint that is
there cannot be read. Not part of
the test suite: 200 kills take some ten minutes on two cores.
"""

import argparse
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CASE = """title = "small dam"
[domain]
min = [0, 0, 0]
max = [0.1, 0.06, 0.15]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.06, 0.05]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.06, 0.15]
faces = ["x-", "x+", "y-", "y+", "z-"]
[grain]
d = 0.005
[[grain.fill]]
min = [0, 0, 0]
max = [0.05, 0.06, 0.05]
count = 40
[time]
end = 0.4
[out]
every = 0.02
[checkpoint]
every = 0.004
"""


def checkpoints(run):
    return sorted((run / "checkpoints").glob("step_*.h5"))


def start(program, folder, run, rng):
    command = [program, "run", "case.toml", "--backend", "cpu", "--threads", "1", "--quiet", "--out", run.name]
    there = checkpoints(run)
    early = rng.choice(there) if there and rng.random() < 0.25 else None
    command += ["--restart", str(early or "latest")] if there else ["--overwrite"]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True)


def part_is_being_written(run):
    return any((run / "checkpoints").glob("*.part")) if (run / "checkpoints").is_dir() else False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--writing", type=int, default=50, help="of them while a checkpoint is written")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    program, rng = options.program.resolve(), random.Random(options.seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_text(CASE)
        whole = folder / "whole"
        begin = time.monotonic()
        if start(program, folder, whole, rng).wait() != 0:
            return "the unbroken run failed"
        length, last = time.monotonic() - begin, checkpoints(whole)[-1]
        kills = writing = runs = failed = 0
        while kills < options.kills:
            runs += 1
            run, hit = folder / f"run_{runs}", 0
            while True:
                process = start(program, folder, run, rng)
                begin, wait = time.monotonic(), rng.uniform(0, 0.7 * length)
                while process.poll() is None:
                    late = time.monotonic() - begin > wait and kills + hit < options.kills
                    if late and (writing >= options.writing or part_is_being_written(run)):
                        writing += part_is_being_written(run)
                        process.send_signal(signal.SIGKILL)
                        process.wait()
                        hit += 1
                    time.sleep(0 if late else 1e-3)
                if process.returncode != -signal.SIGKILL:
                    break
            kills += hit
            error = process.stderr.read().strip()
            same = process.returncode == 0 and checkpoints(run)[-1].read_bytes() == last.read_bytes()
            same = same and checkpoints(run)[-1].name == last.name and (run / "summary.json").exists()
            same = same and (run / "diagnostics.csv").read_bytes() == (whole / "diagnostics.csv").read_bytes()
            failed += not same
            print(f"run {runs}: killed {hit} times, {kills} in all, {writing} within a checkpoint's writing; "
                  f"{'the same bytes' if same else 'DIFFERS ' + error}", flush=True)
        return f"{failed} of {runs} runs differ" if failed else 0


if __name__ == "__main__":
    sys.exit(main())
