"""Cases as objects: `case.fluid.dx = "2 mm"`, with the checks and messages of the program."""

from __future__ import annotations

import functools
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterator, Sequence

import numpy as np

from . import _toml
from ._module import module
from .errors import CaseError, FileError


@functools.cache
def keys() -> dict[str, dict]:
    """Description of each key by its path ("wall.body[].min"): unit, default, allowed, meaning, choices."""
    return {row["path"]: row for row in json.loads(module().parameters())}


@functools.cache
def _children(path: str) -> dict[str, str]:
    """Names below a table of that path, each "table", "list" or "value"."""
    found: dict[str, str] = {}
    for key in keys():
        if path and not key.startswith(path + "."):
            continue
        name, _, rest = key[len(path) + 1 if path else 0 :].partition(".")
        if name.endswith("[]"):
            found[name[:-2]] = "list"
        else:
            found.setdefault(name, "table" if rest else "value")
    return found


def _caller() -> tuple[str, int]:
    """File and line of the code that called into this package."""
    frame = sys._getframe(1)
    while frame and frame.f_globals.get("__name__", "").startswith("bedload."):
        frame = frame.f_back
    if frame is None:
        return "Python", 0
    name = frame.f_code.co_filename
    return ("cell" if name.startswith("<") or "ipykernel" in name else Path(name).name), frame.f_lineno


def _plain(value: Any) -> Any:
    """Plain Python values: numbers for those of NumPy, lists for sequences."""
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return str(value) if isinstance(value, Path) else value


class Section:
    """A table of a case. Its keys are attributes, or items: `section["frame.motion.frequency"]`.

    A table is created by the first value put into it. A key that is not given raises AttributeError, which names the
    default.
    """

    def __init__(self, path: str = "", given: bool = False):
        object.__setattr__(self, "_path", path)
        object.__setattr__(self, "_given", given)  # given even if empty
        object.__setattr__(self, "_values", {})
        object.__setattr__(self, "_places", {})

    # -- by name ---------------------------------------------------------------------------------

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._values:
            return self._values[name]
        kind = _children(self._path).get(name)
        if kind == "value":
            row = keys()[self._below(name)]
            raise AttributeError(f"{row['key']} is not given; its default: {row['default']}")
        if kind is None:
            raise AttributeError(f"{self._path or 'a case'} has no key '{name}'")
        made = Items(self._below(name)) if kind == "list" else Section(self._below(name))
        self._values[name] = made
        return made

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            raise AttributeError(f"keys do not begin with an underscore: {name}")
        self._put(name, value, _caller())

    def __delattr__(self, name: str) -> None:
        self._values.pop(name)
        self._places.pop(name, None)

    def __dir__(self):
        return [*object.__dir__(self), *_children(self._path)]

    # -- as a mapping ----------------------------------------------------------------------------

    def __getitem__(self, key: str) -> Any:
        owner, name = self._owner(key)
        if isinstance(owner, Items):
            return owner.item(name)
        if name not in owner._values:
            raise KeyError(key)
        return owner._values[name]

    def __setitem__(self, key: str, value: Any) -> None:
        owner, name = self._owner(key)
        if isinstance(owner, Items):
            owner[int(name)] = value
        else:
            owner._put(name, value, _caller())

    def __contains__(self, key: str) -> bool:
        try:
            found = self[key]
        except (KeyError, AttributeError, IndexError):
            return False
        return not isinstance(found, Section) or found._holds()

    def __iter__(self) -> Iterator[str]:
        return (name for name, value in self._values.items() if not _absent(value))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Section) and self._tree() == other._tree()

    __hash__ = None  # it may change

    def __repr__(self) -> str:
        return f"<{self._path or 'case'}: {_toml.value(self._tree())}>"

    # -- within ----------------------------------------------------------------------------------

    def _below(self, name: str) -> str:
        return f"{self._path}.{name}" if self._path else name

    def _owner(self, key: str) -> tuple[Any, str]:
        """The table or list that holds the last part of a key."""
        *parts, last = key.split(".")
        at: Any = self
        for part in parts:
            at = at.item(part) if isinstance(at, Items) else getattr(at, part)
        return at, last

    def _put(self, name: str, value: Any, place: tuple[str, int]) -> None:
        self._values[name] = _converted(value, self._below(name), place)
        self._places[name] = place

    def _holds(self) -> bool:
        return self._given or any(not _absent(value) for value in self._values.values())

    def _tree(self) -> dict:
        return {name: _tree(value) for name, value in self._values.items() if not _absent(value)}

    def _located(self, path: str = "") -> Iterator[tuple[str, tuple[str, int]]]:
        """The place of each value by its path in the file."""
        for name, value in self._values.items():
            below = f"{path}.{name}" if path else name
            if name in self._places:
                yield below, self._places[name]
            if isinstance(value, (Section, Items)):
                yield from value._located(below)


class Items(list):
    """A list of tables of a case: `case.wall.body`."""

    def __init__(self, path: str, items: Sequence[Any] = (), place: tuple[str, int] | None = None):
        super().__init__(_converted(item, path + "[]", place or _caller()) for item in items)
        self._path = path

    def add(self, **values: Any) -> Section:
        """Appends a table of these keys and returns it."""
        self.append(values)
        return self[-1]

    def append(self, values: Any) -> None:
        """Appends a table, given as a dict or a section."""
        super().append(_converted(values, self._path + "[]", _caller()))

    def __setitem__(self, at, values) -> None:
        super().__setitem__(at, _converted(values, self._path + "[]", _caller()))

    def item(self, number: str) -> Section:
        """The table with that index, from 0, as in `case["wall.body.0.mu"]`."""
        if not number.isdigit() or int(number) >= len(self):
            what = self._path.replace("[]", "")
            raise IndexError(f"{what}.{number}: this case has {len(self) or 'no'} {what}, indexed from 0")
        return self[int(number)]

    def named(self, name: str) -> Section:
        """The table with that `name`."""
        for item in self:
            if item._values.get("name") == name:
                return item
        raise KeyError(f"{self._path} has no item named '{name}'")

    def _located(self, path: str) -> Iterator[tuple[str, tuple[str, int]]]:
        for k, item in enumerate(self):
            yield from item._located(f"{path}.{k}")


def _absent(value: Any) -> bool:
    return (isinstance(value, Section) and not value._holds()) or (isinstance(value, Items) and not value)


def _tree(value: Any) -> Any:
    if isinstance(value, Section):
        return value._tree()
    return [item._tree() for item in value] if isinstance(value, Items) else value


def _converted(value: Any, path: str, place: tuple[str, int]) -> Any:
    """A value as stored in a case: tables become sections."""
    if isinstance(value, Section):
        value = value._tree()
    if isinstance(value, dict):
        section = Section(path, given=True)
        for name, member in value.items():
            section._put(name, member, place)
        return section
    tables = isinstance(value, (list, tuple)) and value and isinstance(value[0], (dict, Section))
    if isinstance(value, Items) or tables:
        return Items(path, list(value), place)
    return _plain(value)


def devices_text(devices: int | str | Sequence[int] | None) -> str:
    """GPUs as `--devices` takes them: a number of them, or a list of their numbers."""
    if devices is None or isinstance(devices, (int, str)):
        return "" if devices is None else str(devices)
    return ",".join(str(number) for number in devices) + ("," if len(devices) == 1 else "")


def checked_ranks(ranks: int) -> int:
    if not 1 <= ranks <= 256:
        raise CaseError(f"ranks = {ranks} must be within 1..256")
    return ranks


@dataclass
class Report:
    """Result of `Case.check`."""

    fluid: int  #: particles
    walls: int  #: particles
    grains: int  #: in number
    device: str  #: its name
    memory: int  #: of the solver at the end of a run, bytes
    step_limits: dict[str, float]  #: s, by what limits the step
    substep_limits: dict[str, float]  #: s, of DEM substeps
    numerical_viscosity: dict[str, float]  #: as multiples of the physical viscosity
    warnings: list[str]  #: a sentence each
    notes: list[str]  #: what is valid but may surprise, "resolution: ..."
    ranks: list[dict[str, float]]  #: as `Simulation.ranks`, after one step

    @property
    def active_limit(self) -> str:
        """The limit that sets the time step; empty if the case needs more memory than is free."""
        return min(self.step_limits, key=self.step_limits.get, default="")


class Case(Section):
    """A case: from a file, from dicts, or empty.

    Errors name the place of a value, in the file or in the Python code that set it. Names of other files in a case
    (meshes, tables) are relative to its file, those of a case without one to the working directory.
    """

    def __init__(self, source: str | Path | dict | None = None):
        super().__init__("", given=True)
        self._start("case")
        if isinstance(source, dict):
            place = _caller()
            for name, value in source.items():
                self._put(name, value, place)
        elif source is not None:
            path = Path(source)
            try:
                text = path.read_text(encoding="utf-8")
            except FileNotFoundError:
                raise FileError(f"{path}: cannot read this case file: no such file") from None
            except UnicodeDecodeError:
                raise FileError(f"{path}: is not in UTF-8; save it as UTF-8") from None
            except OSError:
                what = "is a folder, not a case file" if path.is_dir() else "cannot read this case file"
                raise FileError(f"{path}: {what}") from None
            self._start(str(path))
            self._parse(text)

    @classmethod
    def from_toml(cls, text: str, name: str = "case") -> Case:
        """A case from the text of a file; `name` is used in messages."""
        case = cls()
        case._start(name)
        case._parse(text)
        return case

    def copy(self) -> Case:
        """A copy of the case."""
        twin = Case()
        twin._start(self._name)
        twin._build(self._tree(), dict(self._located()))
        return twin

    def with_values(self, values: dict[str, Any]) -> Case:
        """A copy with other values of keys ("fluid.dx", "wall.body.0.min")."""
        twin = self.copy()
        for key, value in values.items():
            twin[key] = value
        return twin

    def to_toml(self) -> str:
        """The case as TOML: the given values, without defaults."""
        return _toml.document(self._tree())

    def write(self, path: str | Path) -> None:
        """Writes `to_toml()`."""
        Path(path).write_text(self.to_toml(), encoding="utf-8")

    def resolved(self) -> Case:
        """The case with all defaults filled in. Raises CaseError for an invalid case."""
        return Case.from_toml(self._read().toml(), self._name)

    def warnings(self) -> list[str]:
        """Warnings of the program for this case. Raises CaseError for an invalid case."""
        return self._read().warnings

    def check(self, backend: str = "auto", threads: int = 0, devices: int | str | Sequence[int] | None = None,
              ranks: int = 1) -> Report:
        """As `bedload check`, without its estimate of the run time: places the particles, evaluates the step limits,
        does one step; raises CaseError as the program. Warnings and notes are those that the program prints. devices,
        ranks: as of Simulation."""
        found = module().check(self._read(), backend, threads, devices_text(devices), checked_ranks(ranks))
        values = {name: {key: value[0] for key, value in found[name].items()}
                  for name in ("step_limits", "substep_limits", "numerical_viscosity")}
        fluid, walls, grains = found["counts"]
        return Report(fluid, walls, grains, found["device"], found["memory"], **values, warnings=found["warnings"],
                      notes=found["notes"], ranks=found["ranks"])

    def _start(self, name: str) -> None:
        object.__setattr__(self, "_name", name)

    def _parse(self, text: str) -> None:
        self._build(*module().parse(text, self._name))

    def _build(self, tree: dict, places: dict[str, tuple[str, int]]) -> None:
        for name, value in tree.items():
            self._put(name, value, (self._name, 0))
        _place(self, "", places)

    def _read(self, checkpoint: str | Path = ""):
        return module().read(self._tree(), dict(self._located()), self._name, checkpoint)


def _place(value: Any, path: str, places: dict[str, tuple[str, int]]) -> None:
    """Records the places of the values of a section and everything below it."""
    if isinstance(value, Items):
        for k, item in enumerate(value):
            _place(item, f"{path}.{k}", places)
    elif isinstance(value, Section):
        for name, member in value._values.items():
            below = f"{path}.{name}" if path else name
            if below in places:
                value._places[name] = places[below]
            _place(member, below, places)


def drag_table(
    factor: Callable[[float, float], float],
    porosity: Sequence[float] | None = None,
    reynolds: Sequence[float] | None = None,
) -> dict:
    """A drag law of your own as `case.drag`: `case.drag = bedload.drag_table(lambda porosity, reynolds: ...)`.

    `factor(porosity, reynolds)` is the drag on a grain over its Stokes drag, K / (3 pi mu d), K the force per
    interstitial slip w (kg/s), at the Reynolds number rho porosity w d / mu. It is evaluated at these numbers,
    by default at porosities from 0.3 in steps of 0.05, and at 8 Reynolds numbers a decade from 0.001 to 1e5, and 0.
    """
    nodes = module().drag_nodes()
    porosity, reynolds = nodes[0] if porosity is None else porosity, nodes[1] if reynolds is None else reynolds
    rows = [float(factor(float(eps), float(re))) for eps in porosity for re in reynolds]
    return {"law": "table", "porosity": [float(x) for x in porosity], "reynolds": [float(x) for x in reynolds],
            "factor": rows}
