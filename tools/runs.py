"""Runs cases; ends tools as the program ends."""

import subprocess
import sys

from frames import FileError, summary_of
from bedload._toml import value  # after frames, which finds it


def start_case(program, case, out, settings, *options, command="run", log=None):
    """Runs a case into the folder `out` with `settings` (key -> value) instead of its own, then `options` of
    the command; returns the exit code. What the program prints goes to the open file `log` if there is one."""
    words = [program, command, case, "--out", out]
    for key, number in settings.items():
        words += ["--set", f"{key}={value(number)}"]
    try:
        return subprocess.run([str(word) for word in [*words, *options]], stdout=log, stderr=log).returncode
    except OSError as error:
        raise SystemExit(f"{program}: cannot run: {error.strerror}") from None


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
    except FileError as error:
        print(error, file=sys.stderr)
        sys.exit(2)
    except SystemExit as stop:
        if not isinstance(stop.code, str):
            raise
        print(stop.code, file=sys.stderr)
        sys.exit(2)
