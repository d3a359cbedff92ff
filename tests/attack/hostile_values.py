#!/usr/bin/env python3
"""Gives every key of a case values that nobody should write, and looks at what `bedload check` makes of them.

    hostile_values.py BEDLOAD [--every 1] [--jobs 2] [--only TEXT]

Each value goes into a case that is otherwise in order. The program must accept the case (exit code 0) without a number
that is none, or refuse it (exit code 2) in one sentence that names file, line and key, or its first steps break down (exit
code 3) in one that names particle and place. A refusal takes at most 2 s of processor time and 1 GB; what is accepted
may be as large as `check` says. `--every n` tries each n-th value only. Exits with 1 if any value fails.
"""

import argparse
import copy
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from bases import BASES, FILES

SECONDS, BYTES, PATIENCE = 2, 1 << 30, 60
LONGEST_MESSAGE = 1500
DEEP = "(" * 30000 + "1" + ")" * 30000


class Raw(str):
    """Text of a TOML value as it stands."""


def raw(*texts):
    return [Raw(t) for t in texts]


HUGE = json.dumps("x" * 50000)
ANY = raw("0", "-1", "nan", "inf", "-inf", "1e300", "-1e300", "1e-300", "1e9", "9223372036854775807", "true", '""', HUGE,
          '"\\u00fc\\u2603\\u202e\\U0001f4a5"', '"\\n\\u0000\\u001b[31m"', '"../../x"', "[]", "[1]", "[1, 2, 3, 4, 5, 6, 7, 8]",
          "[[1, 2], [3]]", '["a", 1, true]', "{}", "{ a = 1 }", "1979-05-27", '"1 parsec"', "[" + "0, " * 9999 + "0]")
VECTOR = raw("[nan, 0, 0]", "[0, inf, 0]", "[1e300, 0, 0]", "[0, 0, 0]", "[1e29, 1e29, 1e29]", "[1e9, -1e9, 1e9]",
             "[1e-300, 0, 0]", '["x", "y", "z"]', "[-1, -1, -1]", "[true, false, true]")
FORMULA = ["1/0", "0/0", "ln(-1)", "sqrt(-1)", "-1", "1e300*1e300", "exp(1000)", "sin(", "1 +", "foo", "foo(1)", "t t", "q", "1,5",
           "=", "1 = 2", "x*y*z*t", "\u00fc", DEEP, "-" * 30000 + "1", "sin(" * 30000 + "1" + ")" * 30000, "1" + "+1" * 100000,
           "2^" * 30000 + "1", "1?" * 30000, "max(" + "1," * 100000 + "1)", "x" * 50000, "", " ", "1e999", "0x10",
           "t > 0.05 ? 1/0 : 1", "1/(0.05-t)", "x > 0.03 ? 0/0 : 1"]
KINDS = {
    "vector": VECTOR, "vectors": raw("[[nan, 0, 0]]", "[[1, 2]]", "[[0, 0, 0], [0, 0, 0]]", "[[1e29, 0, 0]]"),
    "rows": raw("[[0, 0, 0, 0]]", "[[0, 0, 0, 0], [0, 1, 0, 0]]", "[[1, 0, 0, 0], [0, 1, 0, 0]]", "[[0, nan, 0, 0], [1, 0, 0, 0]]",
                "[[0, 0, 0, 0], [1e-30, 1e30, 0, 0]]", "[[0, 0, 0, 0], [1, 1, 1]]"),
    "formulas": raw(*(f"[{json.dumps(f)}, 0, 0]" for f in FORMULA)) + VECTOR,
    "spheres": raw("[[0, 0, 0, 0]]", "[[0, 0, 0, -1]]", "[[0, 0, 0, nan]]", "[[0, 0, 0, 1], [0, 0, 0, 1]]", "[[0, 0, 0]]",
                   "[[1e30, 0, 0, 1]]", "[[0, 0, 0, 1e-300], [1, 0, 0, 1e300]]", "[[0, 0, 0, 1], [9, 0, 0, 1]]"),
    "numbers": raw("[nan]", "[-1]", "[0]", "[1e300]", "[2, 1]", "[1, 1]", "[0.1, 0.2, 0.3]", "[" + ", ".join(map(str, range(2000))) + "]"),
    "booleans": VECTOR, "faces": raw('["x-", "x-"]', '["w+"]', '["x-", "y-", "z-", "x+", "y+", "z+"]'),
    "texts": raw('["a", "a"]', '["nothing"]', f"[{HUGE}]"),
    "number": raw("1e30", "1e-30", '"1 mm"', '"1e400 m"', '"nan m"', "-0.0"),
    "integer": raw("-9223372036854775808", "2147483648", "1.5"),
    "text": raw('"/dev/zero"', '"."', '"nothing"', '"a b"'), "boolean": raw('"true"', "2"),
}


def values(row):
    found = ANY + KINDS[row["kind"]]
    return found + raw(*map(json.dumps, FORMULA)) if "formula in" in row["meaning"] else found


def text_of(value):
    if isinstance(value, Raw):
        return value
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {text_of(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(text_of, value)) + "]"
    return json.dumps(value)


def written(table, path=""):
    """A table as TOML."""
    is_list = lambda v: isinstance(v, list) and v and isinstance(v[0], dict)
    lines = [f"{k} = {text_of(v)}" for k, v in table.items() if not isinstance(v, dict) and not is_list(v)]
    for key, value in table.items():
        if isinstance(value, dict):
            lines += [f"[{path}{key}]", written(value, f"{path}{key}.")]
        elif is_list(value):
            for item in value:
                lines += [f"[[{path}{key}]]", written(item, f"{path}{key}.")]
    return "\n".join(lines)


def tables(case, path):
    """Every table of a case in which the last part of a path may stand."""
    found = [case]
    for part in path.split(".")[:-1]:
        name = part.removesuffix("[]")
        found = [t[name] for t in found if name in t]
        if part.endswith("[]"):
            found = [item for items in found for item in items]
    return found


def home(cases, path):
    """Case and number of the table that has the key; else of the first that could have it."""
    key = path.rsplit(".", 1)[-1].removesuffix("[]")
    places = [(name, n, key in table) for name, case in cases.items() for n, table in enumerate(tables(case, path))]
    if not places:
        raise SystemExit(f"no case of bases.py has a table for {path}")
    return next((p for p in places if p[2]), places[0])


class Attack:
    def __init__(self, program, folder, keys):
        self.program, self.folder, self.keys = program, Path(folder), [k for k in keys if "." in k]
        names = {k.rsplit(".", 1)[0] for k in self.keys}
        self.tables = "(" + "|".join(map(re.escape, names)) + r") (\d|\"|must |= )"  # by number or name
        for name, text in FILES.items():
            (self.folder / name).write_text(text)

    def check(self, number, text):
        """Exit code, output, errors, processor seconds and bytes of `bedload check` of a case."""
        case = self.folder / f"{number}.toml"
        case.write_text(text)
        limits = lambda: resource.setrlimit(resource.RLIMIT_AS, (8 * BYTES, 8 * BYTES))
        out, err = self.folder / f"{number}.out", self.folder / f"{number}.err"
        with out.open("wb") as o, err.open("wb") as e:
            process = subprocess.Popen([self.program, "check", case.name, "--threads", "1", "--backend", "cpu"], stdout=o, stderr=e,
                                       cwd=self.folder, preexec_fn=limits)
            end = time.monotonic() + PATIENCE
            while True:
                pid, status, usage = os.wait4(process.pid, os.WNOHANG)
                if pid:
                    break
                if time.monotonic() > end:
                    process.kill()
                    end += PATIENCE
                time.sleep(0.002)
        process.returncode = os.waitstatus_to_exitcode(status)
        answer = process.returncode, out.read_text(errors="replace"), err.read_text(errors="replace"), usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024
        for file in (case, out, err):
            file.unlink()
        return case.name, *answer

    def complaint(self, key, answer):
        """What is wrong with an answer; nothing if it is as it should be."""
        case, code, out, err, seconds, size = answer
        if code == 3 and re.search(r"^(fluid particle|grain|wall.body) .* at \(.* broke down at t = ", err, re.M):
            return None
        if code not in (0, 2):
            return f"exit code {code}: {err.strip()[-300:]}"
        if code == 0:
            return f"accepted with a number that is none: {out}" if re.search(r"(?<![\w/.\"])-?(nan|inf)\b", out) else None
        if seconds > SECONDS or size > BYTES:
            return f"refused after {seconds:.1f} s and {size / BYTES:.2f} GB"
        lines = [line for line in err.splitlines() if line.startswith(case)]
        message = lines[-1] if lines else err.strip()
        if len(err) > LONGEST_MESSAGE + 4000:
            return f"{len(err)} characters of messages"
        if len(message) > LONGEST_MESSAGE:
            return f"a message of {len(message)} characters"
        if not re.match(rf"{re.escape(case)}:\d+: ", message):
            return f"no file and line: {message[:300]}"
        if not any(named in message for named in (key, *self.keys)) and not re.search(self.tables, message):
            return f"no key is named: {message[:300]}"
        return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="keys that contain this text")
    options = parser.parse_args()
    program = options.program.resolve()
    rows = json.loads(subprocess.run([program, "list", "--json"], check=True, capture_output=True, text=True).stdout)
    cases = {name: tomllib.loads(text) for name, text in BASES.items()}
    tries = []
    for row in rows:
        name, n, _ = home(cases, row["path"])
        tries += [(row, name, n, value) for value in values(row) if options.only in row["key"]]
    tries = tries[:: options.every]
    with tempfile.TemporaryDirectory() as folder:
        attack = Attack(program, folder, [row["key"] for row in rows])
        for name, case in cases.items():
            answer = attack.check(name, written(case))
            if answer[1] != 0:
                return f"case {name} of bases.py is refused: {answer[3]}"

        def attempt(job):
            number, (row, name, n, value) = job
            case = copy.deepcopy(cases[name])
            tables(case, row["path"])[n][row["path"].rsplit(".", 1)[-1].removesuffix("[]")] = value
            answer = attack.check(number, written(case))
            wrong = attack.complaint(row["key"], answer)
            if wrong:
                shown = value if len(value) < 100 else value[:60] + f"... ({len(value)} characters)"
                print(f"{name}: {row['key']} = {shown}: {wrong}", flush=True)
            return wrong is not None, answer[1], answer[4], answer[5]

        with ThreadPoolExecutor(options.jobs) as pool:
            answers = list(pool.map(attempt, enumerate(tries)))
    failed = sum(a[0] for a in answers)
    refused = [a for a in answers if a[1] == 2]
    print(f"{len(answers)} values of {len(rows)} keys: {sum(a[1] == 0 for a in answers)} accepted, {len(refused)} refused, "
          f"{sum(a[1] == 3 for a in answers)} broke down, "
          f"{failed} failed; refusals took at most {max((a[2] for a in refused), default=0):.2f} s and "
          f"{max((a[3] for a in refused), default=0) / 1e6:.0f} MB")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
