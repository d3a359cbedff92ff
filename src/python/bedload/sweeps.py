"""Parameter sweeps: many runs of one case with different values of its keys, in parallel processes, continued after an
interruption."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Sequence

from . import _toml
from .errors import CaseError, FileError
from .results import Run, summary_of

SETTINGS = "sweep.json"  # in the folder of each run: its case, values and options


@dataclass
class Point:
    """One run of a sweep."""

    values: dict[str, Any]  #: of the swept keys
    folder: Path  #: of its results
    status: str = "waiting"  #: "completed"; "failed" with `message`; "stopped"
    message: str = ""  #: last message of the program if it failed or lost more than run.max_lost
    reused: bool = False  #: was completed before

    @property
    def run(self) -> Run:
        """The results."""
        return Run(self.folder)


class Sweep:
    """The runs of a sweep, in the order of their values."""

    def __init__(self, points: Sequence[Point]):
        self.points = list(points)

    def __iter__(self):
        return iter(self.points)

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, k: int) -> Point:
        return self.points[k]

    @property
    def failed(self) -> list[Point]:
        """Runs that have not completed."""
        return [point for point in self.points if point.status != "completed"]

    def rows(self, measure: Callable[[Run], dict[str, Any]]) -> list[dict[str, Any]]:
        """Values and results of `measure(run)` of each completed run."""
        return [{**point.values, **measure(point.run)} for point in self.points if point.status == "completed"]

    def to_pandas(self, measure: Callable[[Run], dict[str, Any]]):
        """`rows` as a pandas.DataFrame."""
        import pandas

        return pandas.DataFrame(self.rows(measure))

    def __repr__(self) -> str:
        return f"<Sweep: {len(self)} runs, {len(self.failed)} not completed>"


def sweep(case: Any, keys: dict[str, Sequence[Any]] | Iterable[dict[str, Any]], out: str | Path, *, workers: int = 1,
          threads: int = 0, program: str | Path | Sequence[str] | None = None, options: Sequence[str] = (),
          name: Callable[[dict[str, Any]], str] | None = None, report: Callable[[Point], Any] | None = None) -> Sweep:
    """Runs a case with all combinations of `keys` ({"fluid.dx": [0.002, 0.001], ...}), or with each of a list of dicts.

    case: a Case or a file name. out: folder of the sweep; each run has a subfolder named after its values. workers:
    runs at a time; threads: per run, by default all divided by the workers. program: instead of that of this package.
    options: further options of `bedload run`. name(values): name of the subfolder. report(point): called after a run.

    A completed run of the same case and values is not repeated; an interrupted one restarts from its newest checkpoint,
    if there is one. A failed run does not stop the others.
    """
    out = Path(out)
    points = [Point(values, out / (name or _name)(values)) for values in _combinations(keys)]
    folders = [point.folder for point in points]
    if len(set(folders)) != len(folders):
        raise CaseError("two runs of this sweep have the same values")
    if workers < 1:
        raise CaseError(f"workers = {workers} must be >= 1")
    out.mkdir(parents=True, exist_ok=True)
    file, text = _case_file(case, out)
    command = _command(program)
    each = threads or max(1, (os.cpu_count() or 1) // workers)
    with ThreadPoolExecutor(workers) as pool:
        jobs = [pool.submit(_run, point, command, file, text, each, options, report) for point in points]
        try:
            for job in jobs:
                job.result()
        except BaseException:
            for job in jobs:
                job.cancel()
            raise
    return Sweep(points)


def _run(point: Point, command: list[str], file: Path, text: str, threads: int, options: Sequence[str],
         report: Callable[[Point], Any] | None) -> None:
    marks = {"case": hashlib.sha256(text.encode()).hexdigest(), "values": point.values, "options": list(options)}
    kept = point.folder / SETTINGS
    same = kept.exists() and json.loads(kept.read_text()) == json.loads(json.dumps(marks))
    if same and summary_of(point.folder).get("status") == "completed":
        point.status, point.reused = "completed", True
    else:
        begun = same and any((point.folder / "checkpoints").glob("step_*.h5"))
        point.folder.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(marks, indent=1) + "\n")
        words = [*command, "run", str(file), "--out", str(point.folder), "--threads", str(threads), "--quiet"]
        for key, value in point.values.items():
            words += ["--set", f"{key}={_toml.value(value)}"]
        words += ["--restart", "latest"] if begun else ["--overwrite"]
        try:
            done = subprocess.run([*words, *options], capture_output=True, text=True)
        except OSError as error:
            raise FileError(f"{command[0]}: cannot run: {error.strerror}") from None
        point.status = {0: "completed", 4: "completed", 130: "stopped"}.get(done.returncode, "failed")
        if done.returncode not in (0, 130):  # 4: more was lost than run.max_lost
            point.message = (done.stderr.strip().splitlines() or [f"the program ended with {done.returncode}"])[-1]
    if report:
        report(point)


def _combinations(keys: Any) -> list[dict[str, Any]]:
    all_values = [dict(zip(keys, one)) for one in itertools.product(*keys.values())] if isinstance(keys, dict) else keys
    return [{key: _plain(value) for key, value in one.items()} for one in all_values]


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):  # of NumPy
        return value.tolist()
    return [_plain(item) for item in value] if isinstance(value, (list, tuple)) else value


def _name(values: dict[str, Any]) -> str:
    """Name of the folder for these values: "dx=0.002,mu=0.3"; long names are cut and end with a hash."""
    text = ",".join(f"{key.rsplit('.', 1)[-1]}={_toml.value(value)}" for key, value in values.items())
    name = re.sub(r"[^\w.,=+-]", "_", text.replace('"', ""))
    whole = re.sub(r"\s", "", json.dumps(values))
    clear = len(name) <= 80 and len({key.rsplit(".", 1)[-1] for key in values}) == len(values)
    return name if clear else f"{name[:80]}-{hashlib.sha256(whole.encode()).hexdigest()[:8]}"


def _case_file(case: Any, out: Path) -> tuple[Path, str]:
    """The file to run and its text. A Case is written to `out` with absolute names of its files."""
    if isinstance(case, (str, Path)):
        try:
            return Path(case), Path(case).read_text(encoding="utf-8")
        except OSError:
            raise FileError(f"{case}: cannot read this case file") from None
        except UnicodeDecodeError:
            raise FileError(f"{case}: is not in UTF-8; save it as UTF-8") from None
    text = case.to_toml()
    own = Path(case._name)
    folder = own.parent if own.suffix == ".toml" else Path()
    file = out / "case.toml"
    file.write_text(_with_absolute_files(case, folder.resolve()).to_toml(), encoding="utf-8")
    return file, text


def _with_absolute_files(case: Any, folder: Path) -> Any:
    """A copy with absolute names of its files."""
    twin = case.copy()

    def visit(table: Any) -> None:
        for name, value in list(table._values.items()):
            if isinstance(value, list) and hasattr(value, "add"):
                for item in value:
                    visit(item)
            elif hasattr(value, "_values"):
                visit(value)
            elif name == "file" and isinstance(value, str):
                table._values[name] = str(folder / value)

    visit(twin)
    return twin


def _command(program: Any) -> list[str]:
    if program is None:
        return [sys.executable, "-m", "bedload"]
    words = [str(program)] if isinstance(program, (str, Path)) else list(map(str, program))
    if not shutil.which(words[0]):
        raise FileError(f"{words[0]}: no such program")
    return words
