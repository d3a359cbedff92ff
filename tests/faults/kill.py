#!/usr/bin/env python3
"""Kills runs, goes on from the newest checkpoint, each fourth time from any that is there, and compares all that they
leave with what an unbroken run does.

    kill.py BEDLOAD [--kills 200] [--seed 1]

BEDLOAD is the program. Kills come in turn at any moment, while a checkpoint is being written, while a restart cuts tables
and frames back to its checkpoint, and between the last checkpoint and the end. Prints a line for each run that has come to
its end; exits with 1 if one ends with another last checkpoint, table or frame, or cannot go on. Needs h5py. Not part of the
test suite: 200 kills take some ten minutes on two cores.
"""

import argparse
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py

CASE = """title = "small tank"
[domain]
min = [0, 0, -0.04]
max = [0.1, 0.07, 0.15]
periodic = [false, true, false]
[fluid]
dx = 0.01
vmax = 1.5
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.07, 0.05]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.07, 0.15]
faces = ["x-", "x+", "z-"]
[[wall.body]]
name = "float"
shape = "box"
min = [0.01, 0.02, 0.06]
max = [0.04, 0.05, 0.08]
[wall.body.free]
density = 500
spin = [1.0, 0.5, 0.2]
[[wall.body]]
name = "gate"
shape = "box"
min = [0.075, 0.0, 0.01]
max = [0.085, 0.03, 0.05]
[wall.body.motion]
kind = "oscillation"
amplitude = [0.004, 0, 0]
frequency = 8.0
[[inlet]]
name = "tap"
shape = "rectangle"
centre = [0.05, 0.03, 0.115]
direction = [0, 0, -1]
half_a = [0.02, 0, 0]
half_b = [0, 0.02, 0]
velocity = 0.3
[[outlet]]
name = "drain"
min = [0.085, 0.0, 0.0]
max = [0.1, 0.07, 0.02]
[grain]
d = 0.006
E = 1e6
[[grain.fill]]
min = [0, 0, 0]
max = [0.05, 0.07, 0.05]
count = 30
[[grain_inlet]]
name = "hopper"
min = [0.06, 0.01, 0.09]
max = [0.09, 0.05, 0.11]
rate = 150
[time]
end = 0.12
[out]
every = 0.002
diagnostics_every = 0.003
bodies = "all"
[[probe]]
name = "box"
type = "box"
min = [0, 0, 0]
max = [0.1, 0.07, 0.03]
every = 0.002
[[probe]]
name = "in_float"
type = "point"
body = "float"
at = [0.025, 0.035, 0.07]
[[probe]]
name = "on_tank"
type = "force"
body = "tank"
[checkpoint]
every = 0.004
"""
MOMENTS = ("any", "writing", "any", "cutting", "any", "end")
TIMED = {"summary.json", ".lock"}  # hold how long the run took, or who holds the folder


def checkpoints(run):
    return sorted((run / "checkpoints").glob("step_*.h5"))


def size(file):
    try:
        return file.stat().st_size
    except FileNotFoundError:
        return 0


def same_frames(a, b):
    """Whether two HDF5 files hold the same; how they are laid out depends on how often they were opened."""
    with h5py.File(a) as one, h5py.File(b) as other:
        names = [[], []]
        for file, found in zip((one, other), names):
            file.visit(found.append)
        if names[0] != names[1]:
            return False
        for name in names[0]:
            p, q = one[name], other[name]
            if isinstance(p, h5py.Dataset) and (p.shape != q.shape or p[()].tobytes() != q[()].tobytes()):
                return False
            if sorted(p.attrs) != sorted(q.attrs) or any(str(p.attrs[k]) != str(q.attrs[k]) for k in p.attrs):
                return False
    return True


def differences(run, whole):
    """Names of what is not as in the unbroken run."""
    last = checkpoints(whole)[-1]
    files = {f.relative_to(whole) for f in whole.rglob("*") if f.is_file()} - set(map(Path, TIMED))
    files = {f for f in files if f.parts[0] != "checkpoints"} | {last.relative_to(whole)}
    wrong = []
    for file in sorted(files):
        a, b = whole / file, run / file
        if not b.exists():
            wrong.append(f"{file} (none)")
        elif not (same_frames(a, b) if file.suffix == ".vtkhdf" else a.read_bytes() == b.read_bytes()):
            wrong.append(str(file))
    if checkpoints(run)[-1:] and checkpoints(run)[-1].name != last.name:
        wrong.append(f"last checkpoint {checkpoints(run)[-1].name}")
    extra = {f.relative_to(run) for f in run.rglob("*") if f.is_file()} - {f.relative_to(whole) for f in whole.rglob("*")}
    wrong += [f"{f} (too many)" for f in sorted(extra) if f.suffix != ".h5"]
    if not (run / "summary.json").exists() or json.loads((run / "summary.json").read_text())["status"] != "completed":
        wrong.append("summary.json")
    return wrong


class Killer:
    def __init__(self, program, folder, seed):
        self.program, self.folder, self.rng = program, folder, random.Random(seed)
        self.kills = dict.fromkeys(MOMENTS, 0)
        self.length, self.last = 0, ""

    def start(self, run):
        command = [self.program, "run", "case.toml", "--backend", "cpu", "--threads", "1", "--quiet", "--out", run.name]
        there = checkpoints(run)
        early = self.rng.choice(there) if there and self.rng.random() < 0.25 else None
        command += ["--restart", str(early or "latest")] if there else ["--overwrite"]
        with (self.folder / "errors").open("w") as errors:
            return subprocess.Popen(command, cwd=self.folder, stderr=errors)

    def wait_for(self, moment, run, process):
        """Returns at a moment of that kind, or as the process ends."""
        begin, table = time.monotonic(), run / "diagnostics.csv"
        before = size(table)
        late = self.rng.uniform(0, 0.7 * self.length)
        reached = {
            "any": lambda: time.monotonic() - begin > late,
            "writing": lambda: time.monotonic() - begin > late and any((run / "checkpoints").glob("*.part")),
            "cutting": lambda: size(table) < before or (before == 0 and time.monotonic() - begin > late),
            "end": lambda: (run / "checkpoints" / self.last).exists(),
        }[moment]
        while process.poll() is None and not reached():
            time.sleep(0 if moment != "any" else 1e-3)
        if moment == "cutting":
            time.sleep(self.rng.uniform(0, 0.004))
        if moment == "end":
            time.sleep(self.rng.choice((0, self.rng.uniform(0, 0.03))))

    def one_run(self, run, most):
        """Kills a run up to `most` times, then lets it end; what is wrong with it."""
        hit = 0
        while True:
            process = self.start(run)
            if hit < most:
                moment = MOMENTS[sum(self.kills.values()) % len(MOMENTS)]
                self.wait_for(moment, run, process)
                process.send_signal(signal.SIGKILL)
            if process.wait() != -signal.SIGKILL:
                break
            hit += 1
            self.kills[moment] += 1
        if process.returncode != 0:
            return hit, [f"exit code {process.returncode}: {(self.folder / 'errors').read_text().strip()}"]
        return hit, differences(run, self.folder / "whole")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_text(CASE)
        killer = Killer(options.program.resolve(), folder, options.seed)
        begin = time.monotonic()
        if killer.start(folder / "whole").wait() != 0:
            return "the unbroken run failed: " + (folder / "errors").read_text()
        killer.length, killer.last = time.monotonic() - begin, checkpoints(folder / "whole")[-1].name
        runs = failed = 0
        while sum(killer.kills.values()) < options.kills:
            runs += 1
            left = options.kills - sum(killer.kills.values())
            hit, wrong = killer.one_run(folder / f"run_{runs}", min(left, killer.rng.randint(4, 16)))
            failed += bool(wrong)
            print(f"run {runs}: killed {hit} times; {'DIFFERS: ' + '; '.join(wrong) if wrong else 'the same'}", flush=True)
        print(", ".join(f"{n} {moment}" for moment, n in killer.kills.items()), f"kills in {runs} runs, {failed} differ")
        return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
