"""What the program says about a document: its error and the key it belongs to, warnings, the case with all defaults."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from typing import Any

from .._module import module
from ..case import keys
from ..errors import CaseError, FileError
from .document import Document, bare


@dataclass
class Problem:
    """An error of the program."""

    text: str  #: without file and line
    path: str = ""  #: of the key, "wall.body.0.mu"; of the table if a key is missing that no line has; else empty
    line: int = 0  #: in the file, from 1; 0 if it has none


@dataclass
class Reading:
    problem: Problem | None = None
    warnings: list[str] = field(default_factory=list)
    case: dict[str, Any] = field(default_factory=dict)  #: resolved; as given if there is a problem


def read(document: Document) -> Reading:
    """Reads, resolves and checks a document, as `bedload check` before it places particles."""
    name = str(document.path or "case.toml")
    places: dict[str, tuple[str, int]] = {}
    try:
        tree, places = module().parse(document.text, name)
        found = module().read(tree, places, name, "")
        return Reading(None, list(found.warnings), tomllib.loads(found.toml()))
    except (CaseError, FileError) as error:
        return Reading(problem_of(str(error), name, places), [], document.tree())


def problem_of(message: str, name: str, places: dict[str, tuple[str, int]]) -> Problem:
    """Finds the key of an error by its name and line. places: (file, line) of each value by its path."""
    text, line = message, 0
    if message.startswith(name):
        found = re.match(r"(?::(\d+))?(?::\d+)?: (.*)", message[len(name) :], re.DOTALL)
        if found:
            line, text = int(found[1] or 0), found[2]
    key = re.match(r"[\w.\[\]]+", text)
    return Problem(text, _path(key[0].rstrip(".") if key else "", line, places), line)


def _path(key: str, line: int, places: dict[str, tuple[str, int]]) -> str:
    """The path of a key "wall.body.mu" that is on a line or, if it is missing, in the table that begins there."""
    key = bare(re.sub(r"\[\d*\]", "", key))
    same = [path for path in places if bare(path) == key]
    on_line = [path for path in same if line and places[path][1] == line]
    if on_line or (same and not line):
        return (on_line or same)[0]
    table, _, last = key.rpartition(".")
    owners = [path for path in places if bare(path) == table and f"{path}.0" not in places]
    owners = [path for path in owners if not line or places[path][1] <= line]
    if owners:
        return f"{max(owners, key=lambda path: places[path][1])}.{last}"
    return key if any(row["key"] == key for row in keys().values()) else ""
