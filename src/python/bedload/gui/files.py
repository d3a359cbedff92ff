"""The dialog of files; cases and results that are opened and saved."""

from __future__ import annotations

from pathlib import Path

from .. import results
from ..errors import CaseError, FileError
from .document import Document
from .run import clouds_of_frame


class Files:
    """Actions of a `Window` on files."""

    def new(self) -> None:
        self._open(Document())

    def browse(self, why: str, folder: str | None = None) -> None:
        """Opens the dialog of files: "open", "save" or "results"."""
        at = Path(folder).resolve() if folder else self._folder()
        at = next(place for place in (at, *at.parents) if place.is_dir())
        try:
            entries = sorted(at.iterdir(), key=lambda p: (not p.is_dir(), p.name.lower()))
        except OSError as error:
            self._say(f"{at}: {error.strerror}")
            return
        shown = [{"name": entry.name, "path": str(entry), "folder": entry.is_dir(),
                  "run": (entry / "case.resolved.toml").exists()}
                 for entry in entries if not entry.name.startswith(".") and (entry.is_dir() or entry.suffix == ".toml")]
        name = (self.document.path.name if self.document.path else "case.toml") if why == "save" else ""
        self.state.update({"browse": why, "browse_at": str(at), "browse_up": str(at.parent), "browse_items": shown,
                           "browse_name": self.state.browse_name if self.state.browse == why else name})

    def browse_click(self, path: str, is_folder: bool, is_run: bool) -> None:
        """A line of the dialog of files."""
        why = self.state.browse
        if is_folder and not (is_run and why == "results"):
            self.browse(why, path)
        elif why == "save":
            self.state.browse_name = Path(path).name
        else:
            self.chosen(path)

    def chosen(self, path: str) -> None:
        """A file or folder of the dialog."""
        why, self.state.browse = self.state.browse, ""
        if why == "results":
            self.open_results(path)
        elif why == "open":
            try:
                self._open(Document.open(path))
            except (CaseError, FileError) as error:
                self._say(str(error))
        elif why == "save":
            at = Path(self.state.browse_at) / path
            self._save(at if at.suffix == ".toml" else at.with_name(at.name + ".toml"))

    def save(self) -> None:
        self._save(self.document.path) if self.document.path else self.browse("save")

    def open_results(self, path: str | Path) -> None:
        try:
            found = results.open_run(path)
            stores = [store for store in ("fluid", "grains") if (found.folder / f"{store}.vtkhdf").exists()]
            if not stores:
                raise FileError(f"{path}: has no frames of fluid or grains")
            times = getattr(found, stores[0]).times
        except FileError as error:
            self._say(str(error))
            return
        if found.folder.is_relative_to(Path.cwd()):
            found = results.open_run(found.folder.relative_to(Path.cwd()))
        self.results = found
        walls = (found.folder / "walls.vtkhdf").exists() and len(found.walls)
        self.walls_before = clouds_of_frame(found, 0, ("walls",)).get("walls") if walls else None
        self.state.update({"times": [float(t) for t in times], "frame": max(len(times) - 1, 0), "mode": "results",
                           "results": str(found.folder), "panel": "curves"})
        self._colours(clouds_of_frame(found, 0))
        self._tables(found.folder)
        self._draw()

    def _folder(self) -> Path:
        """Of the case file."""
        return (self.document.path.parent if self.document.path else Path()).resolve()

    def _out(self) -> Path:
        """The results folder, as `bedload run` names it."""
        path = self.document.path.resolve()
        return Path("results") / (path.parent.name if path.stem == "case" else path.stem)

    def _open(self, document: Document) -> None:
        self.document, self.initial, self._checked = document, {}, None
        self.state.update({"selected": "", "mode": "case", "check_rows": [], "check_words": ""})
        self._refresh(fit=True)

    def _save(self, path: Path) -> None:
        try:
            self.document.save(path)
        except FileError as error:
            self._say(str(error))
            return
        self._refresh()
        if self.state.run_after_save:
            self.state.run_after_save = False
            self.ask_run()
