#!/usr/bin/env python3
"""Takes the GPU away from runs in the middle of their work, then goes on from the newest checkpoint.

    device_lost.py BEDLOAD [--times 5] [--seed 1]

BEDLOAD is the program. Runs share the GPU through NVIDIA's multi-process service, whose server is killed: the next call
to the device fails, as with a fault of the hardware. Each run must end with exit code 2 and one sentence that names the
last good checkpoint, leave nothing half-written, and come to the end of an unbroken run, byte for byte, when it goes on
without the service. Needs a GPU and nvidia-cuda-mps-control; exits with 1 if a run does otherwise.
"""

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from kill import CASE, checkpoints  # noqa: E402


def servers():
    found = subprocess.run(["pgrep", "-f", "nvidia-cuda-mps-server"], capture_output=True, text=True).stdout
    return [int(pid) for pid in found.split()]


def run(program, folder, out, *arguments, environment=None):
    command = [program, "run", "case.toml", "--backend", "cuda", "--quiet", "--out", out, *arguments]
    return subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True, env=environment)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--times", type=int, default=5)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    program, rng = options.program.resolve(), random.Random(options.seed)
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "case.toml").write_text(CASE)
        begin = time.monotonic()
        if run(program, folder, "whole").wait() != 0:
            return "the unbroken run failed"
        length, last = time.monotonic() - begin, checkpoints(folder / "whole")[-1]
        pipes = folder / "mps"
        pipes.mkdir()
        service = {**os.environ, "CUDA_MPS_PIPE_DIRECTORY": str(pipes), "CUDA_MPS_LOG_DIRECTORY": str(pipes)}
        for k in range(options.times):
            subprocess.run(["nvidia-cuda-mps-control", "-d"], env=service, check=True)
            out = folder / f"run_{k}"
            process = run(program, folder, out.name, environment=service)
            while process.poll() is None and not checkpoints(out):
                time.sleep(1e-3)
            time.sleep(rng.uniform(0, 0.5 * length))
            for pid in servers():
                os.kill(pid, signal.SIGKILL)
            try:
                code = process.wait(60)
            except subprocess.TimeoutExpired:
                process.kill()
                code = "none, it hangs"
            error = process.stderr.read().strip()
            subprocess.run(["nvidia-cuda-mps-control"], input="quit\n", text=True, env=service)
            told = code == 2 and "\n" not in error and "the last good checkpoint is" in error
            whole = not list(out.rglob("*.part"))
            again = run(program, folder, out.name, "--restart", "latest")
            same = again.wait() == 0 and checkpoints(out)[-1].read_bytes() == last.read_bytes()
            failed += not (told and whole and same)
            print(f"run {k + 1}: exit code {code}, \"{error}\"; {'nothing' if whole else 'SOMETHING'} half-written; "
                  f"goes on to {'the same bytes' if same else 'OTHER BYTES ' + again.stderr.read()}", flush=True)
    return f"{failed} of {options.times} runs did otherwise" if failed else 0


if __name__ == "__main__":
    sys.exit(main())
