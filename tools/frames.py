"""Reads what a run leaves behind: frames (VTKHDF), tables (CSV) and the resolved case; writes tables."""

import csv
import re
import tomllib
from pathlib import Path

import h5py
import numpy as np


class Frames:
    """Frames of one store, e.g. RUN_DIR/fluid.vtkhdf: temporal PolyData of points."""

    def __init__(self, path):
        self.path = Path(path)
        try:
            self._file = h5py.File(self.path, "r")
        except OSError as error:
            raise SystemExit(f"{self.path}: cannot be read: {error}") from None
        self._root = self._file["VTKHDF"]
        steps = self._root["Steps"]
        count = int(steps.attrs["NSteps"])
        self.times = steps["Values"][:count].ravel()
        self._points = steps["PointOffsets"][:count].ravel()
        self._parts = steps["PartOffsets"][:count].ravel() if "PartOffsets" in steps else np.arange(count)

    def fields(self):
        """Names of the arrays of each frame, besides the position."""
        return sorted(self._root["PointData"])

    def nearest(self, time):
        """Number of the frame closest to `time`, s."""
        return int(np.argmin(np.abs(self.times - time)))

    def position(self, frame):
        """Positions [n, 3], m."""
        begin = int(self._points[frame])
        return self._root["Points"][begin : begin + self._count(frame)].astype(float)

    def get(self, frame, name, default=None):
        """Array `name` of a frame, or `default` if the store has none of that name."""
        data = self._root["PointData"]
        if name not in data:
            return default
        offsets = self._root["Steps"].get(f"PointDataOffsets/{name}")
        begin = int(offsets[frame].item() if offsets is not None else self._points[frame])
        return data[name][begin : begin + self._count(frame)].astype(float)

    def _count(self, frame):
        return int(np.ravel(self._root["NumberOfPoints"])[self._parts[frame]])


class Table:
    """A CSV file with one header row; columns by name, with or without their `[unit]`."""

    def __init__(self, path):
        self.path = Path(path)
        try:
            with open(self.path, newline="") as file:
                rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
        except OSError as error:
            raise SystemExit(f"{self.path}: {error.strerror}") from None
        if not rows:
            raise SystemExit(f"{self.path}: is empty")
        self.names = [name.strip() for name in rows[0]]
        self._rows = [row for row in rows[1:] if len(row) == len(self.names)]

    def where(self, conditions):
        """The rows in which each column of `conditions` has the value given."""
        picked = object.__new__(Table)
        picked.path, picked.names, picked._rows = self.path, self.names, self._rows
        for name, value in conditions.items():
            k = self._index(name)
            picked._rows = [row for row in picked._rows if row[k] == str(value)]
        if not picked._rows:
            raise SystemExit(f"{self.path}: has no rows with {conditions}")
        return picked

    def texts(self, name):
        k = self._index(name)
        return [row[k] for row in self._rows]

    def column(self, name):
        """Numbers of one column."""
        try:
            return np.array([float(text) for text in self.texts(name)])
        except ValueError:
            raise SystemExit(f"{self.path}: column '{name}' holds more than numbers") from None

    def numeric(self):
        """Names of the columns that hold nothing but numbers."""
        number = re.compile(r"^[-+]?(\d|\.\d|inf|nan)", re.IGNORECASE)
        return [n for k, n in enumerate(self.names) if all(number.match(row[k]) for row in self._rows)]

    def _index(self, name):
        bare = [re.sub(r"\s*\[.*\]$", "", known) for known in self.names]
        for names in (self.names, bare):
            if name in names:
                return names.index(name)
        raise SystemExit(f"{self.path}: has no column '{name}', only {', '.join(self.names)}")


def write_table(path, names, rows):
    """A CSV file of one header row, `names`, and `rows`."""
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(names)
        out.writerows(rows)


def resolved_case(run_dir):
    """case.resolved.toml of a run as nested dicts; empty if there is none."""
    path = Path(run_dir) / "case.resolved.toml"
    if not path.exists():
        return {}
    with open(path, "rb") as file:
        return tomllib.load(file)


def case_of(run_dir):
    """case.resolved.toml of a run that must have one."""
    case = resolved_case(run_dir)
    if not case:
        raise SystemExit(f"{run_dir}: holds no case.resolved.toml")
    return case
