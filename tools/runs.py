"""Runs cases, and reads the summaries that runs leave behind; ends tools as the program ends."""

import json
import subprocess
import sys
from pathlib import Path


def summary_of(run_dir):
    """summary.json of a run as nested dicts; empty if there is none."""
    path = Path(run_dir) / "summary.json"
    return json.loads(path.read_text()) if path.exists() else {}


def in_toml(value):
    """A number, truth, text or list of these as `--set` takes it."""
    if isinstance(value, bool):
        return str(value).lower()
    return f"[{', '.join(map(in_toml, value))}]" if isinstance(value, list) else str(value)


def start_case(program, case, out, settings, *options, command="run", log=None):
    """Runs a case into the folder `out` with `settings` (key -> value) instead of its own, then `options` of
    the command; returns the exit code. What the program prints goes to the open file `log` if there is one."""
    words = [program, command, case, "--out", out]
    for key, value in settings.items():
        words += ["--set", f"{key}={in_toml(value)}"]
    try:
        return subprocess.run([str(word) for word in [*words, *options]], stdout=log, stderr=log).returncode
    except OSError as error:
        raise SystemExit(f"{program}: cannot be run: {error.strerror}") from None


def run_case(program, case, out, settings, *options):
    """As start_case, for a run that must succeed; returns the summary."""
    code = start_case(program, case, out, settings, *options)
    if code:
        raise SystemExit(f"{out}: the program ended with {code}")
    return summary_of(out)


def finish(main):
    """Runs a tool's main and ends with what it returns, or with 2 and a message if its input was wrong."""
    try:
        sys.exit(main())
    except SystemExit as stop:
        if not isinstance(stop.code, str):
            raise
        print(stop.code, file=sys.stderr)
        sys.exit(2)
