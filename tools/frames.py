"""The reader of results of the package for Python, for tools and for scripts of cases: from the source tree, without its
compiled module. What it cannot read ends them with its sentence, as the program ends."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "src" / "python"))
from bedload.errors import FileError  # noqa: E402
from bedload.measures import running_mean, spectrum  # noqa: E402
from bedload.results import Frames, Table, case_of, resolved_case, summary_of, write_table  # noqa: E402

__all__ = ["FileError", "Frames", "Table", "case_of", "resolved_case", "running_mean", "spectrum",
           "summary_of", "write_table"]


def _end(kind, error, trace):
    if issubclass(kind, FileError):
        print(error, file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


sys.excepthook = _end
