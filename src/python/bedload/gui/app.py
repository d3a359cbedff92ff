"""The page: the case on the left, the picture on the right, checks, curves and text below it."""

from __future__ import annotations

import asyncio
import tempfile
from pathlib import Path
from time import monotonic

import numpy as np
from trame.app import get_server

from .. import results
from ..errors import CaseError, FileError
from . import forms, page, reading, scene
from .document import Document
from .drawing import Drawing
from .editing import Editing
from .files import Files
from .pointer import Pointer
from .run import Check, Cloud, LiveRun, clouds_of_frame
from .view import NONE, View

TURN = 0.3  # s between two looks at what runs
ENDS = ("", "completed", "stopped", "failed")  # states in which nothing runs


class Window(Editing, Files, Drawing, Pointer):
    """The state of one window, its checks and runs. Actions are the methods that the page calls."""

    def __init__(self, document: Document):
        self.server = get_server("bedload", client_type="vue3")
        self.state, self.document = self.server.state, document
        self.view = View()
        self.reading = reading.read(document)
        self.check: Check | None = None
        self.run: LiveRun | None = None
        self.results: results.Run | None = None
        self.initial: dict[str, Cloud] = {}  # particles that the check has placed
        self.walls_before: Cloud | None = None
        self._parts_of: tuple[dict, list[scene.Part]] | None = None  # the last case that was drawn, and its parts
        self._curves_at = 0.0  # when the tables of a run were last read, s
        self._checked: str | None = None  # the text that the last check was of
        self._begun: dict[str, list[str]] = {}  # vectors of which not all is typed yet, by path
        self._temporary = tempfile.TemporaryDirectory(prefix="bedload_gui_")
        self._own_file: Path | None = None
        self.state.update(page.STATE)
        page.build(self)
        self._refresh(fit=True)
        self._listen()
        self.server.controller.on_server_ready.add(lambda **_: asyncio.create_task(self._watch()))
        for names, react in ((("colour_fluid", "colour_grains", "cut", "cut_at", "mode", "hide_walls"), self._draw),
                             (("frame",), self._draw), (("table", "columns"), self._draw_curves)):
            self.state.change(*names)(lambda react=react, **_: react())
        self.state.change("mesh")(lambda mesh, **_: self.add_mesh(mesh))
        self.state.change("table")(lambda **_: self._choose_columns())

    def close(self) -> None:
        """Ends what runs."""
        if self.check:
            self.check.cancel()
        if self.run and not self.run.poll().ended:
            self.run.stop()
            self.run.wait(20)
        self._forget_own_file()
        self._temporary.cleanup()

    # -- checks and runs -------------------------------------------------------------------------

    def start_check(self) -> None:
        if self.reading.problem:
            self.show_problem()
            return
        if self.check:
            self.check.cancel()
        self._forget_own_file()
        stem = self.document.path.stem if self.document.path else "case"
        self._own_file = self._folder() / f".{stem}.gui.toml"  # beside the case, for the files it names
        try:
            self._own_file.write_text(self.document.text, encoding="utf-8")
        except OSError as error:
            self._say(f"{self._own_file}: cannot be written: {error.strerror}")
            return
        self._checked = self.document.text
        self.check = Check(self._own_file, Path(self._temporary.name) / "preview")
        self.state.update({"checking": True, "panel": "check", "mode": "case"})

    def ask_run(self) -> None:
        """Run: saves the case, and asks what to do about a run that is there already."""
        if self.reading.problem:
            self.show_problem()
        elif not self.document.path:
            self.state.run_after_save = True
            self.browse("save")
        else:
            if self.document.changed:
                self._save(self.document.path)
            out = self._out()
            if (out / "case.resolved.toml").exists():
                found = any((out / "checkpoints").glob("*.h5"))
                self.state.update({"ask_run": True, "run_out": str(out), "can_restart": found})
            else:
                self.start_run()

    def start_run(self, restart: bool = False, overwrite: bool = False) -> None:
        self.state.update({"ask_run": False, "run_error": ""})
        if not self.run and self.state.colour_fluid == NONE:
            self.state.colour_fluid = "velocity"
        self.results = None
        before = self._out() / "walls.vtkhdf"
        self.walls_before = clouds_of_frame(results.open_run(self._out()), 0, ("walls",))["walls"] \
            if restart and before.exists() else None
        self.run = LiveRun(self.document.path, self._out(), restart=restart, overwrite=overwrite,
                           allow_changes=restart and self.state.allow_changes)
        self.state.update({"mode": "run", "run_state": "starting", "run_words": "placing particles", "panel": "curves",
                           "times": [], "results": "", "run_part": 0})

    def pause(self) -> None:
        if self.run:
            self.run.resume() if self.run.progress.state == "paused" else self.run.pause()

    def stop(self) -> None:
        if self.run:
            self.run.stop()
            self.state.run_words = "writing the last frame and a checkpoint"

    # -- within ----------------------------------------------------------------------------------

    def _say(self, words: str) -> None:
        self.state.update({"message": words, "message_seen": True})

    def _refresh(self, fit: bool = False) -> None:
        """Everything that follows from the document."""
        document = self.document
        if self.state.selected and document.get(self.state.selected) is None:
            self.state.selected = ""
        self.reading = reading.read(document)
        problem, path = self.reading.problem, self.state.selected
        fields = forms.fields(document, path, problem)
        self._begun = {field.path: self._begun[field.path] for field in fields if field.path in self._begun}
        for field in fields:
            field.texts = self._begun.get(field.path, field.texts)
        if document.text != self._checked:
            self.initial = {}
        self.state.update({
            "nodes": forms.plain(forms.tree(document, problem)), "fields": forms.plain(fields),
            "additions": forms.plain(forms.additions(document, path)) if path else [],
            "root_additions": forms.plain(forms.additions(document, "")),
            "form_title": forms.title(path, document.get(path)) if path else "Case",
            "file": document.path.name if document.path else "unnamed", "changed": document.changed,
            "can_undo": document.can_undo, "can_redo": document.can_redo, "text": document.text,
            "problem": problem.text if problem else "", "problem_line": problem.line if problem else 0,
            "problem_here": any(f.error for f in fields), "warnings": self.reading.warnings,
            "stale": bool(self.state.check_rows) and document.text != self._checked,
            "out": str(self._out()) if document.path else "",
        })
        if fit:
            self.view.look_from("3-D", self._parts())
        if self.state.mode == "case":
            self._draw()

    async def _watch(self) -> None:
        """Takes in, every now and then, what a check and a run report."""
        while True:
            await asyncio.sleep(TURN)
            with self.state:
                try:
                    if self.check and self.state.checking and self.check.poll():
                        self._check_ended()
                    if self.run and self.state.run_state not in ENDS:
                        self._watch_run()
                except (CaseError, FileError, OSError, KeyError, ValueError) as error:
                    self._say(str(error))

    def _check_ended(self) -> None:
        check = self.check
        self._forget_own_file()
        words = "" if check.passed else check.text
        self.state.update({"checking": False, "check_words": words,
                           "check_rows": [{"about": a, "says": s} for a, s in check.rows()] if check.passed else []})
        if check.passed:
            found = results.open_run(check.preview)
            self.initial = clouds_of_frame(found, 0)
            self._colours(self.initial)
            self.state.stale = self.document.text != self._checked
            self._draw()

    def _watch_run(self) -> None:
        run, seen = self.run, self.run.seen
        progress = run.poll()
        done = progress.time / progress.end if progress.end else 0
        words = {"running": f"t = {progress.time:.4g} s of {progress.end:.4g} s, step {progress.step}, "
                            f"dt {progress.dt:.3g} s by {progress.limit}, {progress.rate:.0f} steps/s, "
                            f"{_duration(progress.seconds_left)} left",
                 "paused": f"paused at t = {progress.time:.4g} s, step {progress.step}",
                 "failed": progress.message}.get(progress.state)
        self.state.update({"run_state": progress.state, "run_part": 100 * done,
                           "run_words": words or self.state.run_words})
        if run.seen != seen and self.state.mode == "run":
            self._draw()
        run.look()
        if progress.state != "starting" and self.state.panel == "curves" and monotonic() > self._curves_at + 1:
            self._tables(run.out)
            self._curves_at = monotonic()
        if progress.ended:
            self.state.run_words = f"{progress.state} at t = {progress.time:.4g} s"
            self.state.run_error = progress.message if progress.state == "failed" else ""
            if (run.out / "fluid.vtkhdf").exists() or (run.out / "grains.vtkhdf").exists():
                self.open_results(run.out)
            else:
                self.state.mode = "case"

    def _forget_own_file(self) -> None:
        if self._own_file:
            self._own_file.unlink(missing_ok=True)
            self._own_file = None


def _duration(seconds: float) -> str:
    if not np.isfinite(seconds):
        return "?"
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
