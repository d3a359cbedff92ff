"""Forms of a case, made from the descriptions of its keys: the tree of its tables and the fields of one table."""

from __future__ import annotations

import re
import tomllib
from dataclasses import asdict, dataclass, field
from typing import Any

from .. import _toml
from ..case import _children, keys
from .document import Document, bare
from .reading import Problem

TITLES = {
    "": "Case", "domain": "Domain", "shape": "Shapes", "frame": "Moving frame", "fluid": "Fluid",
    "fluid.fill": "Fills", "fluid.species": "Species", "eos": "Equation of state", "pressure": "Pressure",
    "sdpd": "SDPD", "density": "Density", "visc": "Viscosity", "shift": "Shifting", "drive": "Body force",
    "contact": "Contacts", "contact.pair": "Pairs of materials", "lubrication": "Lubrication", "wall": "Walls",
    "wall.body": "Bodies", "inlet": "Inlets", "outlet": "Outlets", "grain": "Grains", "grain.fill": "Fills",
    "grain.material": "Materials", "grain_inlet": "Grain inlets", "couple": "Coupling", "drag": "Drag", "time": "Time",
    "run": "Run", "out": "Output", "checkpoint": "Checkpoints", "probe": "Probes", "paper": "Papers",
    "add": "Added motions", "free": "Free body", "rigid": "Rigid groups",
}  # by path, or by the last name of any path
ICONS = {
    "": "mdi-file-document-outline", "domain": "mdi-cube-outline", "shape": "mdi-shape-outline",
    "frame": "mdi-axis-arrow", "fluid": "mdi-water", "fluid.fill": "mdi-water", "wall": "mdi-wall",
    "wall.body": "mdi-wall", "inlet": "mdi-arrow-right-bold-outline", "outlet": "mdi-arrow-right-bold-box-outline",
    "grain": "mdi-dots-hexagon", "grain.fill": "mdi-dots-hexagon", "grain.material": "mdi-dots-hexagon",
    "grain_inlet": "mdi-tray-arrow-down", "time": "mdi-timer-outline", "out": "mdi-tray-arrow-up",
    "checkpoint": "mdi-content-save-outline", "probe": "mdi-gauge", "wall.body.motion": "mdi-rotate-3d-variant",
    "frame.motion": "mdi-rotate-3d-variant", "wall.body.free": "mdi-ferry",
}
COMMON = ["domain", "shape", "fluid", "wall", "grain", "time", "out", "probe", "inlet", "outlet", "grain_inlet",
          "checkpoint"]  # first in the menu of what can be added


@dataclass
class Node:
    """A line of the tree: a table, or a list of tables and its items."""

    path: str
    title: str
    icon: str
    depth: int
    is_list: bool = False
    wrong: bool = False  #: it, or something below it, has the error


@dataclass
class Field:
    """A key of a table."""

    path: str
    name: str
    widget: str  #: "text", "choice", "vector" (a text per axis), "switch"
    unit: str
    meaning: str
    allowed: str
    default: str
    required: bool
    given: bool
    texts: list[str]  #: what it shows: one text, or one per axis
    choices: list[dict[str, str]] = field(default_factory=list)  #: title, value, meaning
    error: str = ""


@dataclass
class Addition:
    """A table that can be added."""

    path: str
    title: str
    icon: str
    is_list: bool


def _pattern(path: str) -> str:
    """The path of a table as `keys()` has it: "wall.body.0.motion" is "wall.body[].motion"."""
    return re.sub(r"\.\d+(?=\.|$)", "[]", path)


def title(path: str, tree: Any = None) -> str:
    """What the tree calls a table: an item of a list by its name, or by what is in it."""
    if not re.search(r"\.\d+$", path):
        name = path.rsplit(".", 1)[-1]
        return TITLES.get(bare(path)) or TITLES.get(name) or name.replace("_", " ").capitalize()
    values = tree if isinstance(tree, dict) else {}
    words = [str(values[key]) for key in ("name", "shape", "kind", "file") if isinstance(values.get(key), str)]
    words += [f"{key} = {value}" for key, value in values.items() if isinstance(value, (int, float, str))]
    return words[0] if words else f"{int(path.rsplit('.', 1)[1]) + 1}"


def tree(document: Document, problem: Problem | None = None) -> list[Node]:
    """The tables of a document from top to bottom."""
    wrong = problem.path if problem else ""
    nodes = [Node("", TITLES[""], ICONS[""], 0)]

    def visit(path: str, values: Any, depth: int) -> None:
        is_list = isinstance(values, list)
        nodes.append(Node(path, title(path, values), ICONS.get(bare(path), "mdi-circle-small"), depth, is_list))
        members = enumerate(values) if is_list else values.items()
        for key, value in members:
            if isinstance(value, dict) or _is_tables(value):
                visit(f"{path}.{key}", value, depth + 1)

    for key, value in document.tree().items():
        if isinstance(value, dict) or _is_tables(value):
            visit(key, value, 0)
    above = [node for node in nodes if node.path and f"{wrong}.".startswith(f"{node.path}.")]
    for node in (above or nodes[:1]) if wrong else []:
        node.wrong = True
    return nodes


def additions(document: Document, path: str) -> list[Addition]:
    """The tables that can be added to a table or, to the case itself, at the top; to a list its next item."""
    values = document.get(path)
    if isinstance(values, list):
        return [Addition(path, _singular(path), ICONS.get(bare(path), "mdi-plus"), True)]
    found = []
    for name, kind in _children(_pattern(path)).items():
        below = f"{path}.{name}" if path else name
        if kind == "value" or (kind == "table" and name in (values or {})):
            continue
        words = _singular(below) if kind == "list" else title(below)
        found.append(Addition(below, words, ICONS.get(bare(below), "mdi-plus"), kind == "list"))
    if not path:
        found.sort(key=lambda one: COMMON.index(one.path) if one.path in COMMON else len(COMMON))
    return found


def fields(document: Document, path: str, problem: Problem | None = None) -> list[Field]:
    """The keys of a table that count with its kind, those that are given or required first."""
    values = document.get(path, {})
    if isinstance(values, list):
        return []
    pattern = _pattern(path)
    rows = [row for row in keys().values() if row["path"].rpartition(".")[0] == pattern]
    kinds = {choice["name"] for row in rows for choice in row["choices"]}
    chosen = _chosen(rows, values)
    found = []
    for row in rows:
        name = row["path"].rpartition(".")[2]
        given = name in values
        if not given and not _applies(row["meaning"], kinds, chosen):
            continue
        below = f"{path}.{name}" if path else name
        error = problem.text if problem and problem.path == below else ""
        required = row["required"] or row["default"].startswith("required")
        found.append(Field(below, name, _widget(row), "" if row["unit"] == "-" else row["unit"], row["meaning"],
                           row["allowed"] if not row["choices"] else "", row["default"], required, given,
                           _texts(document, below, row) if given else _none(row), _choices(document, row), error))
    stray = problem and problem.path.rpartition(".")[0] == path and problem.path not in {f.path for f in found}
    if stray and isinstance(values.get(problem.path.rpartition(".")[2]), (str, int, float, bool, list)):
        found.append(Field(problem.path, problem.path.rpartition(".")[2], "text", "", "", "", "", False, True,
                           [document.source(problem.path)], [], problem.text))
    return sorted(found, key=lambda f: not (f.given or f.required or f.error))


def source(path: str, texts: list[str]) -> str:
    """What was typed into a field as TOML. What is no number where one should be stays text, so that the program can
    say what is wrong with it."""
    kind = keys().get(_pattern(path), {}).get("kind", "")
    if kind == "vector":
        return "[" + ", ".join(_number(text) for text in texts) + "]"
    text = texts[0].strip()
    if kind in ("number", "integer"):
        return _number(text)
    if kind == "boolean":
        return text.lower() if text.lower() in ("true", "false") else _toml.value(text)
    if kind == "text" or not kind and not _is_toml(text):
        return _toml.value(text)
    if _is_toml(text):
        return text
    if _is_toml(f"[{text}]"):
        return f"[{text}]"
    parts = [part.strip().strip("\"'") for part in text.strip("[]").split(",")]
    return _toml.value([part for part in parts if part])


def plain(things: list[Any]) -> list[dict[str, Any]]:
    """Dicts, for a page."""
    return [asdict(thing) for thing in things]


def suggested_name(document: Document, path: str) -> dict[str, Any]:
    """The first values of a new item: a name that is free, if its list has names."""
    if f"{_pattern(path)}[].name" not in keys():
        return {}
    taken = {item.get("name") for item in document.get(path, [])}
    stem = _singular(path).split()[-1].lower()
    return {"name": next(name for k in range(1, len(taken) + 2) if (name := f"{stem}{k}") not in taken)}


def _singular(path: str) -> str:
    words = {"shape": "Shape", "fluid.fill": "Fluid fill", "fluid.species": "Fluid species", "wall.body": "Wall body",
             "inlet": "Inlet", "outlet": "Outlet", "grain.fill": "Grain fill", "grain.material": "Grain material",
             "grain_inlet": "Grain inlet", "probe": "Probe", "contact.pair": "Pair of materials"}
    return words.get(bare(path), title(path).rstrip("s"))


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def _widget(row: dict) -> str:
    if row["kind"] == "vector":
        return "vector"
    if row["kind"] == "boolean":
        return "switch"
    return "choice" if row["choices"] or _refers(row) else "text"


def _refers(row: dict) -> str:
    """The list whose names a key takes: "shape"."""
    words = row["meaning"] + " " + row["allowed"]
    if row["kind"] != "text" or row["path"].endswith(".name"):
        return ""
    found = re.search(r"name of (?:a|the) (shape|wall body|fluid\.species|grain\.material|\[\[shape\]\])", words)
    return {"wall body": "wall.body", "[[shape]]": "shape"}.get(found[1], found[1]) if found else ""


def _choices(document: Document, row: dict) -> list[dict[str, str]]:
    if row["kind"] != "text":
        return []
    found = [{"title": c["name"], "value": c["name"], "meaning": c["meaning"]} for c in row["choices"]]
    if refers := _refers(row):
        items = document.get(refers, [])
        names = [item.get("name") for item in items if isinstance(item, dict)] if isinstance(items, list) else []
        found += [{"title": name, "value": name, "meaning": refers} for name in names if isinstance(name, str)]
    return found


def _chosen(rows: list[dict], values: dict) -> set[str]:
    """The kinds that are chosen in a table, by default where none is given. A name of a shape is a kind, too."""
    found = set()
    for row in rows:
        if row["choices"] and row["kind"] == "text":
            given = values.get(row["path"].rpartition(".")[2], row["default"].strip('"'))
            found.add(given if isinstance(given, str) else "")
    if "shape" in values:
        found.add("shape")
    return found


def _applies(meaning: str, kinds: set[str], chosen: set[str]) -> bool:
    """Whether a key whose meaning begins "sphere, capsule: ..." counts with what is chosen."""
    named = []
    for clause in meaning.split("; "):
        head = set(clause.partition(": ")[0].split(", ")) if ": " in clause else set()
        if head and head <= kinds:
            named.append(head)
        elif not named:  # it begins with no kinds, and counts with all
            return True
    return any(head & chosen for head in named)


def _none(row: dict) -> list[str]:
    return ["", "", ""] if row["kind"] == "vector" else [""]


def _texts(document: Document, path: str, row: dict) -> list[str]:
    value = document.get(path)
    if row["kind"] == "vector" and isinstance(value, list):
        given = [v if isinstance(v, str) else document.source(f"{path}.{k}") for k, v in enumerate(value)]
        return (given + ["", "", ""])[:3]
    if isinstance(value, str):
        return [value, "", ""] if row["kind"] == "vector" else [value]
    text = re.sub(r"\s*\n\s*", " ", document.source(path))
    return [text, "", ""] if row["kind"] == "vector" else [text]


def _number(text: str) -> str:
    text = text.strip()
    return text if re.fullmatch(r"[-+]?(\d[\d_]*\.?\d*([eE][-+]?\d+)?|inf|nan)", text) and _is_toml(text) \
        else _spelled(text)


def _spelled(text: str) -> str:
    """"1.", ".5" and "007" are numbers to a person, though not in TOML."""
    try:
        return _toml.value(float(text))
    except ValueError:
        return _toml.value(text)


def _is_toml(text: str) -> bool:
    try:
        tomllib.loads(f"v = {text}")
    except tomllib.TOMLDecodeError:
        return False
    return True
