#!/usr/bin/env python3
"""Puts a thread of a run on several ranks to sleep for ever, then goes on from the newest checkpoint on other ranks.

    silent_rank.py BEDLOAD

BEDLOAD is the program. A small library that is loaded before it makes the first rank that waits for another never wake,
as if its GPU hung. After a minute the run must end with exit code 2 and one sentence that names the rank and the last
good checkpoint, and come to the end of an unbroken run, byte for byte, when it goes on with one rank more. Needs gcc;
exits with 1 if the run does otherwise. Takes about 70 s.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CASE = """[domain]
min = [0, 0, 0]
max = [0.6, 0.1, 0.6]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.2, 0.1, 0.2]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.6, 0.1, 0.6]
faces = ["x-", "x+", "y-", "y+", "z-"]
[run]
block = 1
[time]
end = 0.06
[out]
every = 0.03
[checkpoint]
every = 0.02
"""

SLEEPER = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

/* Waiting ranks sleep by this; of those the first never wakes, once there is a file of that name. */
int nanosleep(const struct timespec* time, struct timespec* rest) {
  static atomic_int asleep;
  if (getpid() != gettid() && access(getenv("SLEEP_FROM"), F_OK) == 0 && !atomic_exchange(&asleep, 1))
    for (;;) pause();
  int (*const original)(const struct timespec*, struct timespec*) = dlsym(RTLD_NEXT, "nanosleep");
  return original(time, rest);
}
"""


def checkpoints(folder):
    return sorted((folder / "checkpoints").glob("*"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    program = parser.parse_args().program.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_text(CASE)
        (folder / "sleeper.c").write_text(SLEEPER)
        subprocess.run(["gcc", "-shared", "-fPIC", "sleeper.c", "-o", "sleeper.so", "-ldl"], cwd=folder, check=True)

        def run(out, *arguments, **more):
            options = "--backend", "cpu", "--threads", "2", "--quiet", "--out", out
            command = [program, "run", "case.toml", *options, *arguments]
            return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True, **more)

        whole = run("whole")
        if whole.wait() != 0:
            return f"the unbroken run failed: {whole.stderr.read()}"
        begin, out = time.monotonic(), folder / "out"
        broken = run("out", "--ranks", "2", env={**os.environ, "LD_PRELOAD": str(folder / "sleeper.so"),
                                                 "SLEEP_FROM": str(folder / "now"), "OMP_WAIT_POLICY": "passive"})
        while broken.poll() is None and not checkpoints(out):
            time.sleep(1e-3)
        (folder / "now").touch()
        try:
            code = broken.wait(120)
        except subprocess.TimeoutExpired:
            broken.kill()
            code = "none, it hangs"
        error = broken.stderr.read().strip().split("\n")[-1]  # after warnings
        told = code == 2 and re.fullmatch(r"rank [01] has not responded for 60 s, in \w+ of step \d+; "
                                          r"the last good checkpoint is out/checkpoints/\S+", error)
        print(f"exit code {code} after {time.monotonic() - begin:.0f} s, \"{error}\"")
        again = run("out", "--restart", "latest", "--ranks", "3")
        same = again.wait() == 0 and checkpoints(out)[-1].read_bytes() == checkpoints(folder / "whole")[-1].read_bytes()
        print(f"goes on to {'the same bytes' if same else 'OTHER BYTES ' + again.stderr.read()}")
        return 0 if told and same else 1


if __name__ == "__main__":
    sys.exit(main())
