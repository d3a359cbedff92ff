"""A small tank of water with grains, and runs of it."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
os.environ.setdefault("OMP_NUM_THREADS", "1")

TANK = """title = "tank"
[domain]
min = [-0.1, -0.1, -0.1]
max = [0.2, 0.2, 0.2]
[fluid]
dx = 0.01
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.1, 0.08]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.12]
[grain]
d = 0.01
[[grain.fill]]
positions = [[0.05, 0.05, 0.02], [0.061, 0.05, 0.02], [0.03, 0.05, 0.06]]
[[probe]]
name = "front"
type = "front"
direction = "x+"
[time]
end = 0.02
[out]
every = 0.005
[checkpoint]
every = 0.01
"""


def write_case(folder, text=TANK):
    path = Path(folder) / "tank.toml"
    path.write_text(text)
    return path


def program(*arguments):
    """Exit code, standard output and standard error of the program."""
    done = subprocess.run([sys.executable, "-m", "bedload", *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr


def folder():
    return tempfile.TemporaryDirectory(prefix="bedload_python_")
