"""Runs cases, and reads the summaries that runs leave behind."""

import json
import subprocess
from pathlib import Path


def summary_of(run_dir):
    """summary.json of a run as nested dicts; empty if there is none."""
    path = Path(run_dir) / "summary.json"
    return json.loads(path.read_text()) if path.exists() else {}


def run_case(program, case, out, settings, *options):
    """Runs a case into the folder `out` with `settings` (key -> value) instead of its own, then `options` of
    `bedload run`; returns the summary."""
    command = [program, "run", case, "--out", out]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    try:
        code = subprocess.run([str(word) for word in [*command, *options]]).returncode
    except OSError as error:
        raise SystemExit(f"{program}: cannot be run: {error.strerror}") from None
    if code:
        raise SystemExit(f"{out}: the program ended with {code}")
    return summary_of(out)
