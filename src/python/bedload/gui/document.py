"""A case file that is edited: keys set, tables added and removed, comments and order kept, undone and redone."""

from __future__ import annotations

import copy
import difflib
import functools
import re
import tomllib
from pathlib import Path
from typing import Any

import tomlkit
import tomlkit.exceptions

from ..errors import CaseError, FileError


class Document:
    """The text of a case file and its history. Paths are those of `--set`: "wall.body.0.min".

    Each edit changes only the lines it must. While the text is not valid TOML (`error`), only `set_text` can edit it.
    """

    def __init__(self, text: str = "", path: str | Path | None = None):
        self.path = Path(path) if path else None
        self._texts, self._at = [text], 0
        self._saved: str | None = text if path else ""

    @classmethod
    def open(cls, path: str | Path) -> Document:
        try:
            return cls(Path(path).read_text(encoding="utf-8"), path)
        except FileNotFoundError:
            raise FileError(f"{path}: cannot read this case file: no such file") from None
        except UnicodeDecodeError:
            raise FileError(f"{path}: is not in UTF-8; save it as UTF-8") from None
        except OSError as error:
            raise FileError(f"{path}: cannot read this case file: {error.strerror}") from None

    # -- reading ---------------------------------------------------------------------------------

    @property
    def text(self) -> str:
        return self._texts[self._at]

    @property
    def changed(self) -> bool:
        """It differs from the file."""
        return self.text != self._saved

    @property
    def error(self) -> str:
        """Why the text is not TOML; empty if it is."""
        try:
            tomllib.loads(self.text)
        except tomllib.TOMLDecodeError as error:
            return str(error)
        return ""

    def tree(self) -> dict[str, Any]:
        """Plain values; empty while the text is not TOML."""
        try:
            return tomllib.loads(self.text)
        except tomllib.TOMLDecodeError:
            return {}

    def get(self, path: str, default: Any = None) -> Any:
        """The plain value of a key, table or list."""
        return _find(self.tree(), path, default)

    def source(self, path: str) -> str:
        """The value of a key as it is written in the file: "1e7", "[0, 0, 1]"; empty if it is not given."""
        if self.error:
            return ""
        item = _find(_parsed(self.text), path, None)
        return "" if item is None else tomlkit.item(item).as_string().strip()

    # -- editing ---------------------------------------------------------------------------------

    def set(self, path: str, source: str) -> None:
        """Gives a key the value that `source` is in TOML. Its tables are made if they are missing."""
        try:
            value = tomllib.loads(f"v = {source}")["v"]
            item = tomlkit.value(source)
        except (tomllib.TOMLDecodeError, tomlkit.exceptions.TOMLKitError):
            raise CaseError(f"{path} = {source} is not a value of TOML") from None
        *tables, key = path.split(".")
        self._edit(lambda root: _put(_made(root, tables, tomlkit.table), key, item),
                   lambda root: _put(_made(root, tables, lambda **_: {}), key, value))

    def remove(self, path: str) -> None:
        """Removes a key, a table or an item of a list, and a list that is empty without it."""
        self._edit(lambda root: _remove(root, path.split(".")), lambda root: _remove(root, path.split(".")))

    def add(self, path: str, values: dict[str, Any] | None = None, item: bool = False) -> str:
        """Adds a table, or an item to a list of tables (`item`), and returns its path."""
        values = values or {}
        *tables, key = path.split(".")
        count = len(self.get(path, [])) if item else 0

        def added(make, make_list):
            def edit(root):
                owner = _made(root, tables, make)
                table = make()
                for name, value in values.items():
                    table[name] = value
                if not item:
                    owner[key] = table
                elif key in owner:
                    owner[key].append(table)
                else:
                    listed = make_list()
                    listed.append(table)
                    owner[key] = listed
            return edit

        inline = isinstance(self.get(path), list) and self.source(path).startswith("[{")
        self._edit(added(tomlkit.inline_table if inline else tomlkit.table, tomlkit.aot),
                   added(lambda **_: {}, list))
        return f"{path}.{count}" if item else path

    def set_text(self, text: str) -> None:
        """Replaces the whole text."""
        if text != self.text:
            self._texts[self._at + 1 :] = [text]
            self._at += 1

    # -- history ---------------------------------------------------------------------------------

    @property
    def can_undo(self) -> bool:
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        return self._at + 1 < len(self._texts)

    def undo(self) -> None:
        self._at = max(self._at - 1, 0)

    def redo(self) -> None:
        self._at = min(self._at + 1, len(self._texts) - 1)

    def save(self, path: str | Path | None = None) -> Path:
        """Writes the file, to another `path` if one is given."""
        target = Path(path) if path else self.path
        if target is None:
            raise FileError("the case has no file name yet")
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(self.text, encoding="utf-8")
        except OSError as error:
            raise FileError(f"{target}: cannot be written: {error.strerror}") from None
        self.path, self._saved = target, self.text
        return target

    def _edit(self, edit, same_in_plain_values) -> None:
        """Edits the text, and makes sure that the values of the file have changed as those of the tree did."""
        if self.error:
            raise CaseError(f"the text is not TOML: {self.error}")
        root, plain = tomlkit.parse(self.text), copy.deepcopy(self.tree())
        gathered = tomlkit.dumps(root)
        same_in_plain_values(plain)
        edit(root)
        text = _spaced(self.text, _in_order(self.text, gathered, tomlkit.dumps(root)))
        try:
            kept = _without_empty(tomllib.loads(text)) == _without_empty(plain)
        except tomllib.TOMLDecodeError:
            kept = False
        if not kept:
            raise CaseError("this edit cannot be made without rewriting other lines; make it in the text")
        self.set_text(text)


def bare(path: str) -> str:
    """A path without indices: "wall.body.0.min" is "wall.body.min"."""
    return re.sub(r"\.\d+(?=\.|$)", "", path)


@functools.lru_cache(maxsize=2)
def _parsed(text: str):
    """To read from only: `_edit` has its own."""
    return tomlkit.parse(text)


def _find(tree: Any, path: str, default: Any) -> Any:
    for part in filter(None, path.split(".")):
        try:
            tree = tree[int(part) if isinstance(tree, list) else part]
        except (KeyError, IndexError, ValueError, TypeError):
            return default
    return tree


def _made(tree: Any, parts: list[str], make) -> Any:
    """The table at `parts`; missing ones are made, without a header if they will hold only tables."""
    for k, part in enumerate(parts):
        if isinstance(tree, list):
            tree = tree[int(part)]
        else:
            if part not in tree:
                tree[part] = make(is_super_table=True) if k + 1 < len(parts) else make()
            tree = tree[part]
    return tree


def _put(table: Any, key: str, value: Any) -> None:
    table[int(key) if isinstance(table, list) else key] = value


def _remove(tree: Any, parts: list[str]) -> None:
    part, *rest = parts
    key = int(part) if isinstance(tree, list) else part
    if rest:
        below = tree[key]
        _remove(below, rest)
        if not isinstance(below, list) or len(below):
            return
    del tree[key]


def _without_empty(value: Any) -> Any:
    """Without empty tables and lists, which mean nothing in a case."""
    if isinstance(value, dict):
        kept = {key: _without_empty(member) for key, member in value.items()}
        return {key: member for key, member in kept.items() if member not in ({}, [])}
    return [_without_empty(member) for member in value] if isinstance(value, list) else value


def _in_order(text: str, gathered: str, edited: str) -> str:
    """`edited` with its tables in the order of `text`: tomlkit gathers the items of a list of tables between which
    other tables stand, as it has done in `gathered`."""
    if gathered == text:
        return edited
    old, before, after = _blocks(text), _blocks(gathered), _blocks(edited)
    bare_old, bare_before = [block.strip() for block in old], [block.strip() for block in before]
    places, free = [], list(range(len(old)))
    for block in bare_before:
        place = next((k for k in free if bare_old[k] == block), None)
        if place is None:
            return edited
        free.remove(place)
        places.append(place)
    found: list[tuple[int, int, str]] = []  # place in `text`, order of what is new after it, block
    matcher = difflib.SequenceMatcher(None, bare_before, [block.strip() for block in after], autojunk=False)
    for tag, i, i_end, j, j_end in matcher.get_opcodes():
        for k in range(j_end - j):
            place = places[i + k] if i + k < i_end else places[i_end - 1] if i_end else -1
            new = after[j + k].strip("\n")
            kept = i + k < i_end
            ending = old[place][len(old[place].rstrip("\n")) :] if kept else "\n\n"
            found.append((place, 0 if kept else j + k + 1, old[place] if tag == "equal" else new + ending))
    return "".join(block for _, _, block in sorted(found, key=lambda one: one[:2]))


def _blocks(text: str) -> list[str]:
    """A text split before each header of a table."""
    return [block for block in re.split(r"(?m)^(?=\[)", text) if block]


def _spaced(before: str, after: str) -> str:
    """`after` with an empty line around tables that are new in it."""
    new = after.splitlines()
    fresh = set()
    for tag, _, _, first, last in difflib.SequenceMatcher(None, before.splitlines(), new, autojunk=False).get_opcodes():
        if tag != "equal" and any(line.startswith("[") for line in new[first:last]):
            fresh |= set(range(first, last))
    out: list[str] = []
    for k, line in enumerate(new):
        touched = k in fresh or k - 1 in fresh
        if line.startswith("[") and touched and out and out[-1].strip() and not out[-1].startswith("#"):
            out.append("")
        out.append(line)
    return "\n".join(out).lstrip("\n") + "\n" if out else ""
