"""Results of runs, read on demand: frames (VTKHDF), tables (CSV), the resolved case, the summary.

Needs NumPy and h5py; xarray and pandas only for conversions to them.
"""

from __future__ import annotations

import csv
import functools
import json
import re
import tomllib
from pathlib import Path
from typing import Any, Iterator, Sequence

import h5py
import numpy as np

from .errors import FileError


class Frames:
    """Frames of one store, e.g. RUN_DIR/fluid.vtkhdf: temporal PolyData of points, or of lines (contacts), or
    ImageData of the nodes of a lattice. Arrays are read on demand.

    times: of the frames, s.
    """

    def __init__(self, path: str | Path):
        self.path = Path(path)
        try:
            self._file = h5py.File(self.path, "r")
        except OSError as error:
            raise FileError(f"{self.path}: cannot be read: {error}") from None
        self._root = self._file["VTKHDF"]
        steps = self._root["Steps"]
        count = int(steps.attrs["NSteps"])
        self.times: np.ndarray = steps["Values"][:count].ravel()
        self._image = "WholeExtent" in self._root.attrs
        self._lines = "CellData" in self._root and "PointData" not in self._root
        self._arrays = "CellData" if self._lines else "PointData"
        if self._image:
            return
        self._points = steps["PointOffsets"][:count].ravel()
        self._parts = steps["PartOffsets"][:count].ravel() if "PartOffsets" in steps else np.arange(count)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        last = f", 0 .. {self.times[-1]:.4g} s" if len(self) else ""
        return f"<Frames {self.path}: {len(self)} frames{last}; {', '.join(self.names())}>"

    def names(self) -> list[str]:
        """Names of the arrays of each frame."""
        return sorted(["ends" if self._lines else "position", *self._root[self._arrays]])

    def unit(self, name: str) -> str:
        """Unit of an array: "m/s"; "-" for a pure number; empty if the file has none."""
        if name in ("position", "ends"):
            return "m"
        unit = self._data(name).attrs.get("unit", "")
        return unit.decode() if isinstance(unit, bytes) else str(unit)

    def nearest(self, time: float) -> int:
        """Number of the frame closest to `time`, s."""
        return int(np.argmin(np.abs(self.times - time)))

    def count(self, frame: int) -> int:
        """Number of particles in a frame, of lines, or of nodes."""
        if self._image:
            return int(np.prod(self._cells()))
        points = int(np.ravel(self._root["NumberOfPoints"])[self._parts[frame]])
        return points // 2 if self._lines else points

    def position(self, frame: int) -> np.ndarray:
        """Positions [n, 3], m."""
        return self.read(frame, "position").astype(float)

    def get(self, frame: int, name: str, default: Any = None) -> Any:
        """Array `name` of a frame, or `default` if there is none."""
        return self.read(frame, name).astype(float) if name in self._root[self._arrays] else default

    def read(self, frame: int, name: str) -> np.ndarray:
        """Array `name` of a frame, or its "position", in the type and order of the file. Lines have "ends" [n, 2, 3]
        in place of positions."""
        frame = range(len(self))[frame]  # from the end if negative
        if self._image:
            return self._of_nodes(frame, name)
        if name == "ends" and self._lines:
            begin, count = int(self._points[frame]), self.count(frame)
            return self._root["Points"][begin : begin + 2 * count].reshape(count, 2, 3)
        if name == "position" and not self._lines:
            data, begin = self._root["Points"], int(self._points[frame])
        else:
            data = self._data(name)
            offsets = self._root["Steps"].get(f"{self._arrays}Offsets/{name}")
            begin = int(offsets[frame].item() if offsets is not None else self._points[frame])
        return data[begin : begin + self.count(frame)]

    def by_id(self, frame: int, name: str) -> np.ndarray:
        """As `read`, sorted by particle id, an order that is stable while the particles stay the same."""
        return self.read(frame, name)[np.argsort(self.read(frame, "id"))]

    def to_xarray(self):
        """An xarray.Dataset over (time, particle, axis): `particle` is the id, values are NaN where it is absent.

        Frames are read on demand. Integer arrays become floating if particles come or go.
        """
        if self._lines:
            raise FileError(f"{self.path}: holds lines, whose number changes; read them frame by frame")
        from ._xarray import dataset_of

        return dataset_of(self)

    def _cells(self) -> np.ndarray:
        """Number of nodes along x, y, z."""
        return np.asarray(self._root.attrs["WholeExtent"])[1::2] + 1

    def _of_nodes(self, frame: int, name: str) -> np.ndarray:
        """Array of an image in the order of nodes, x fastest."""
        if name == "position":
            origin, spacing = self._root.attrs["Origin"], self._root.attrs["Spacing"]
            x, y, z = (origin[k] + spacing[k] * np.arange(n) for k, n in enumerate(self._cells()))
            return np.stack([a.ravel() for a in np.meshgrid(z, y, x, indexing="ij")][::-1], axis=1)
        data = self._data(name)
        values = data[int(self._root[f"Steps/PointDataOffsets/{name}"][frame].item())]
        return values.reshape(-1) if values.ndim == 3 else values.reshape(-1, values.shape[-1])

    def _data(self, name: str):
        data = self._root[self._arrays]
        if name not in data:
            raise FileError(f"{self.path}: has no array '{name}', only {', '.join(self.names())}")
        return data[name]


class Table:
    """A CSV file with one header row; columns by name, with or without their `[unit]`.

    header: as in the file, `["time [s]", ...]`.
    """

    def __init__(self, path: str | Path):
        self.path = Path(path)
        try:
            with open(self.path, newline="") as file:
                rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
        except OSError as error:
            raise FileError(f"{self.path}: {error.strerror}") from None
        if not rows:
            raise FileError(f"{self.path}: is empty")
        self.header = [name.strip() for name in rows[0]]
        self._rows = [row for row in rows[1:] if len(row) == len(self.header)]

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.column(name)

    def __repr__(self) -> str:
        return f"<Table {self.path}: {len(self)} rows of {', '.join(self.names())}>"

    def names(self) -> list[str]:
        """Names of the columns without units."""
        return [_bare(name) for name in self.header]

    def where(self, conditions: dict[str, Any]) -> Table:
        """The rows whose columns have the values of `conditions`."""
        picked = object.__new__(Table)
        picked.path, picked.header, picked._rows = self.path, self.header, self._rows
        for name, value in conditions.items():
            k = self._index(name)
            picked._rows = [row for row in picked._rows if row[k] == str(value)]
        if not picked._rows:
            raise FileError(f"{self.path}: has no rows with {conditions}")
        return picked

    def texts(self, name: str) -> list[str]:
        """Cells of one column, as they stand in the file."""
        k = self._index(name)
        return [row[k] for row in self._rows]

    def column(self, name: str) -> np.ndarray:
        """Numbers of one column."""
        try:
            return np.array([float(text) for text in self.texts(name)])
        except ValueError:
            raise FileError(f"{self.path}: column '{name}' is not numeric") from None

    def unit(self, name: str) -> str:
        """Unit of a column: "m/s"; empty if it has none."""
        full = self.header[self._index(name)]
        return full[full.rindex("[") + 1 : -1] if full.endswith("]") else ""

    def numeric(self) -> list[str]:
        """Names of the numeric columns."""
        number = re.compile(r"^[-+]?(\d|\.\d|inf|nan)", re.IGNORECASE)
        return [n for k, n in enumerate(self.header) if all(number.match(row[k]) for row in self._rows)]

    def to_pandas(self):
        """A pandas.DataFrame of the numbers over the first column; `attrs["units"]` has their units."""
        import pandas

        names = self.numeric()
        frame = pandas.DataFrame({_bare(name): self.column(name) for name in names})
        frame.attrs["units"] = {_bare(name): self.unit(name) for name in names}
        return frame.set_index(_bare(names[0]))

    def _index(self, name: str) -> int:
        for names in (self.header, self.names()):
            if name in names:
                return names.index(name)
        raise FileError(f"{self.path}: has no column '{name}', only {', '.join(self.header)}")


class Run:
    """A results folder."""

    def __init__(self, folder: str | Path):
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise FileError(f"{self.folder}: no such results folder")

    def __repr__(self) -> str:
        return f"<Run {self.folder}: {self.status}>"

    @functools.cached_property
    def case(self) -> dict:
        """case.resolved.toml: every key with its value."""
        return case_of(self.folder)

    @property
    def summary(self) -> dict:
        """summary.json; empty before the end of the run."""
        return summary_of(self.folder)

    @property
    def status(self) -> str:
        """"completed", "stopped", "failed", or "unfinished" if there is no summary."""
        return self.summary.get("status", "unfinished")

    @functools.cached_property
    def fluid(self) -> Frames:
        """Frames of the fluid."""
        return Frames(self.folder / "fluid.vtkhdf")

    @functools.cached_property
    def grains(self) -> Frames:
        """Frames of the grains."""
        return Frames(self.folder / "grains.vtkhdf")

    @functools.cached_property
    def clumps(self) -> Frames:
        """Frames of the clumps that grains form."""
        return Frames(self.folder / "clumps.vtkhdf")

    @functools.cached_property
    def walls(self) -> Frames:
        """Frames of the wall particles."""
        return Frames(self.folder / "walls.vtkhdf")

    @functools.cached_property
    def contacts(self) -> Frames:
        """Frames of single contacts of grains (`out.contacts`)."""
        return Frames(self.folder / "contacts.vtkhdf")

    @functools.cached_property
    def diagnostics(self) -> Table:
        """Masses, momenta, energies, extremes, counters."""
        return Table(self.folder / "diagnostics.csv")

    @functools.cached_property
    def spectra(self) -> Table:
        """Spectra of what contacts dissipate (`out.spectra`): several rows, one for each bin, of each time."""
        return Table(self.folder / "spectra.csv")

    @functools.cached_property
    def spectra_peaks(self) -> Table:
        """Peak elastic energies and normal forces of contacts, as `spectra`."""
        return Table(self.folder / "spectra_peaks.csv")

    @functools.cached_property
    def probes(self) -> Tables:
        """Tables of probes by name."""
        return Tables(self.folder / "probes")

    @functools.cached_property
    def bodies(self) -> Tables:
        """Tables of wall bodies and rigid groups by name."""
        return Tables(self.folder / "bodies")


class Tables:
    """Tables of a folder by name."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._known: dict[str, Table] = {}

    def names(self) -> list[str]:
        """Names of the tables."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def __len__(self) -> int:
        return len(self.names())

    def __getitem__(self, name: str) -> Table:
        if name not in self._known:
            self._known[name] = Table(self.folder / f"{name}.csv")
        return self._known[name]

    def __repr__(self) -> str:
        return f"<Tables {self.folder}: {', '.join(self.names())}>"


def open_run(folder: str | Path) -> Run:
    """Opens a results folder; files are read on demand."""
    return Run(folder)


def resolved_case(run_dir: str | Path) -> dict:
    """case.resolved.toml of a run as nested dicts; empty if there is none."""
    path = Path(run_dir) / "case.resolved.toml"
    if not path.exists():
        return {}
    with open(path, "rb") as file:
        return tomllib.load(file)


def case_of(run_dir: str | Path) -> dict:
    """case.resolved.toml of a run that must have one."""
    case = resolved_case(run_dir)
    if not case:
        raise FileError(f"{run_dir}: has no case.resolved.toml")
    return case


def summary_of(run_dir: str | Path) -> dict:
    """summary.json of a run as nested dicts; empty if there is none."""
    path = Path(run_dir) / "summary.json"
    return json.loads(path.read_text()) if path.exists() else {}


def write_table(path: str | Path, names: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """Writes a CSV file with the header `names` and `rows`."""
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(names)
        out.writerows(rows)


def _bare(name: str) -> str:
    """Name of a column without its unit."""
    return re.sub(r"\s*\[.*\]$", "", name)
