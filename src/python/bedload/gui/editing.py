"""What is done to the case: fields, tables, text, meshes dropped in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..errors import CaseError, FileError
from . import forms


class Editing:
    """Actions of a `Window` on its document."""

    def select(self, path: str) -> None:
        self.state.selected = path
        self._refresh()

    def set_text(self, path: str, text: str, axis: int | None = None) -> None:
        """What was typed into a field; an empty one means the default."""
        fields = forms.fields(self.document, path.rpartition(".")[0], self.reading.problem)
        field = next((f for f in fields if f.path == path), None)
        if field is None:
            return  # of a table that has just been removed
        texts = self._begun.pop(path, list(field.texts))
        if texts[axis or 0] == text:
            return
        texts[axis or 0] = text
        if not any(part.strip() for part in texts):
            self.reset(path)
        elif axis is not None and not field.given and not all(part.strip() for part in texts):
            self._begun[path] = texts
        else:
            self._edit(lambda: self.document.set(path, forms.source(path, texts)))

    def set_value(self, path: str, value: Any) -> None:
        """What was chosen in a list or by a switch."""
        text = str(value).lower() if isinstance(value, bool) else str(value)
        self._edit(lambda: self.document.set(path, forms.source(path, [text])))

    def reset(self, path: str) -> None:
        """Back to the default: the key is removed."""
        if self.document.get(path) is not None:
            self._edit(lambda: self.document.remove(path))

    def add(self, path: str, is_list: bool) -> None:
        values = forms.suggested_name(self.document, path) if is_list else {}

        def added():
            self.state.selected = self.document.add(path, values, item=is_list)

        self._edit(added)

    def remove(self, path: str) -> None:
        def removed():
            self.document.remove(path)
            self.state.selected = path.rpartition(".")[0] if self.document.get(path.rpartition(".")[0]) else ""

        self._edit(removed)

    def undo(self) -> None:
        self._edit(self.document.undo)

    def redo(self) -> None:
        self._edit(self.document.redo)

    def write_text(self, text: str) -> None:
        """The text as edited by hand."""
        self._edit(lambda: self.document.set_text(text))

    def show_problem(self) -> None:
        """Selects the table that has the error."""
        problem = self.reading.problem
        if problem and problem.path:
            table = problem.path.rpartition(".")[0]
            while table and self.document.get(table) is None:
                table = table.rpartition(".")[0]
            self.select(table)
        else:
            self.state.panel = "text"

    def add_mesh(self, file: dict | list | None) -> None:
        """A mesh that was dropped in: it is saved beside the case and becomes a shape."""
        file = file[0] if isinstance(file, list) and file else file
        if not file:
            return
        name = Path(file["name"]).name

        def added():
            content = file["content"]
            content = b"".join(content) if isinstance(content, list) else content
            path = self._folder() / name
            if path.suffix.lower() not in (".stl", ".obj", ".ply", ".asc"):
                raise CaseError(f"{name} must be an STL, OBJ or PLY file, or a height map (.asc)")
            if path.exists() and path.read_bytes() != content:
                raise FileError(f"{path}: there is another mesh of that name; rename one of them")
            path.write_bytes(content)
            kind = "terrain" if path.suffix.lower() == ".asc" else "mesh"
            values = {"name": Path(name).stem, "kind": kind, "file": name}
            self.state.selected = self.document.add("shape", values, item=True)

        self._edit(added)
        self.state.mesh = None

    def _edit(self, edit) -> None:
        try:
            edit()
        except (CaseError, FileError, OSError, KeyError) as error:
            self._say(str(error))
        self._refresh()
