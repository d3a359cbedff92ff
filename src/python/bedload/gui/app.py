"""The page: the case on the left, the picture on the right, checks, curves and text below it."""

from __future__ import annotations

import asyncio
import tempfile
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
from trame.app import get_server
from vtkmodules.vtkInteractionStyle import vtkInteractorStyleUser

from .. import results
from ..errors import CaseError, FileError
from . import curves, forms, moving, page, reading, scene
from .document import Document
from .run import Check, Cloud, LiveRun, clouds_of_frame
from .view import NONE, Look, View, moved_bodies, write_film

TURN = 0.3  # s between two looks at what runs
ENDS = ("", "completed", "stopped", "failed")  # states in which nothing runs


class Window:
    """The state of one window. Actions are the methods that the page calls."""

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
        self._dragged, self._pressed = "", (0, 0)  # path of what is dragged; where the button went down, pixels
        self._parts_of: tuple[dict, list[scene.Part]] | None = None  # the last case that was drawn, and its parts
        self._curves_at = 0.0  # when the tables of a run were last read, s
        self._checked: str | None = None  # the text that the last check was of
        self._begun: dict[str, list[str]] = {}  # vectors of which not all is typed yet, by path
        self._temporary = tempfile.TemporaryDirectory(prefix="bedload_gui_")
        self._own_file: Path | None = None
        self.state.update(page.STATE)
        page.build(self)
        self._refresh(fit=True)
        self.interactor = self.view.plotter.iren.interactor
        for event, react in (("LeftButtonPressEvent", self._press), ("MouseMoveEvent", self._drag),
                             ("LeftButtonReleaseEvent", self._drop)):
            self.interactor.AddObserver(event, react, 1.0)  # before the style, which moves the camera
        self.view.plotter.iren.add_observer("LeftButtonReleaseEvent", self._release)  # of the style
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

    # -- the case --------------------------------------------------------------------------------

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

    # -- files -----------------------------------------------------------------------------------

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

    # -- the picture -----------------------------------------------------------------------------

    def look_from(self, direction: str) -> None:
        self.view.look_from(direction, self._parts())
        self._push()

    def save_picture(self) -> None:
        from PIL import Image

        folder = Path(self.state.results or self._folder())
        taken = len(list(folder.glob("picture_*.png")))
        path = folder / f"picture_{taken + 1:03}.png"
        Image.fromarray(self.view.picture(scale=2)).save(path)
        self._say(f"wrote {path}")
        self._push()

    async def save_film(self) -> None:
        """A film of all frames, seen as now."""
        if not self.results or self.state.filming:
            return
        path, count, shown = self.results.folder / "film.mp4", len(self.state.times), self.state.frame
        fixed = self._limits_of_all()

        def pictures():
            for k in range(count):
                self._draw_frame(k, fixed)
                yield self.view.picture()

        for done in write_film(path, pictures()):
            with self.state:
                self.state.filming = 100 * done / count
            await asyncio.sleep(0)
        with self.state:
            self.state.filming = 0
            self._draw_frame(shown)
            self._say(f"wrote {path}")
            self._push()

    # -- within ----------------------------------------------------------------------------------

    def _folder(self) -> Path:
        """Of the case file."""
        return (self.document.path.parent if self.document.path else Path()).resolve()

    def _out(self) -> Path:
        """The results folder, as `bedload run` names it."""
        path = self.document.path.resolve()
        return Path("results") / (path.parent.name if path.stem == "case" else path.stem)

    def _say(self, words: str) -> None:
        self.state.update({"message": words, "message_seen": True})

    def _edit(self, edit) -> None:
        try:
            edit()
        except (CaseError, FileError, OSError, KeyError) as error:
            self._say(str(error))
        self._refresh()

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

    def _parts(self) -> list[scene.Part]:
        case, folder = self.reading.case, self._folder()
        if self.state.mode == "results" and self.results:
            case, folder = self.results.case, self.results.folder
        if self._parts_of is None or self._parts_of[0] is not case:
            self._parts_of = case, scene.parts_of(case, folder)
        return self._parts_of[1]

    def _draw(self) -> None:
        if self.state.mode == "results" and self.results:
            self._draw_frame(int(self.state.frame))
        elif self.state.mode == "run" and self.run:
            self._draw_live()
        else:
            self._draw_case()
        self._push()

    def _draw_case(self) -> None:
        parts, path = self._parts(), self.state.selected
        clouds = self.initial
        if clouds:
            parts = [part for part in parts if ".fill." not in part.path]
        self.view.show(parts, path, clouds, self._look(), self._spacing(self.reading.case),
                       outline=scene.shape_outline(self.reading.case, path, self._folder()))

    def _draw_live(self) -> None:
        run = self.run
        if run.clouds and not self.state.colours_fluid[1:]:
            self._colours(run.clouds)
        before = self.walls_before or run.first_walls
        moved = moved_bodies(self.reading.case, before, run.clouds.get("walls"))
        self.view.show(self._shown(run.clouds), "", run.clouds, self._look(), self._spacing(self.reading.case),
                       run.progress.time, moved)

    def _draw_frame(self, frame: int, limits: dict | None = None) -> None:
        found, case = self.results, self.results.case
        clouds = clouds_of_frame(found, frame)
        time = float(self.state.times[frame]) if self.state.times else 0.0
        walls = clouds_of_frame(found, found.walls.nearest(time), ("walls",)).get("walls") \
            if self.walls_before is not None else None
        self.view.show(self._shown(clouds), "", clouds, self._look(limits), self._spacing(case), time,
                       moved_bodies(case, self.walls_before, walls))

    def _shown(self, clouds: dict[str, Cloud]) -> list[scene.Part]:
        """Parts that are shown with particles."""
        left_out = (".fill.", ".motion", "probe.") if clouds else ()
        parts = [part for part in self._parts() if not any(word in part.path for word in left_out)]
        return [part for part in parts if not (self.state.hide_walls and part.path.startswith("wall"))]

    def _look(self, limits: dict | None = None) -> Look:
        return Look({"fluid": self.state.colour_fluid, "grains": self.state.colour_grains},
                    self.state.cut, float(self.state.cut_at), limits=limits)

    def _limits_of_all(self) -> dict[str, tuple[float, float]]:
        """Limits of the colours over some frames, so that a film keeps them."""
        from .view import limits_of, values_of

        found: dict[str, list[np.ndarray]] = {}
        count = len(self.state.times)
        for k in np.unique(np.linspace(0, count - 1, min(count, 12), dtype=int)):
            for store, cloud in clouds_of_frame(self.results, int(k)).items():
                values = values_of(cloud, getattr(self.state, f"colour_{store}"))
                if values is not None:
                    found.setdefault(store, []).append(values)
        return {store: limits_of(np.concatenate(all_)) for store, all_ in found.items()}

    @staticmethod
    def _spacing(case: dict[str, Any]) -> float:
        from .._surfaces import metres

        try:
            return metres(case["fluid"]["dx"])
        except (KeyError, TypeError, ValueError, AttributeError):
            return 0.0

    def _colours(self, clouds: dict[str, Cloud]) -> None:
        for store in ("fluid", "grains"):
            names = [NONE, *sorted(clouds[store].fields)] if store in clouds else []
            self.state[f"colours_{store}"] = names
            if self.state[f"colour_{store}"] not in names:
                self.state[f"colour_{store}"] = "velocity" if store == "fluid" and "velocity" in names else NONE

    def _push(self) -> None:
        self.server.controller.view_update()

    def _tables(self, folder: Path) -> None:
        found = list(curves.tables_of(folder))
        if found != self.state.tables:
            self.state.tables = found
        if self.state.table not in found:
            self.state.table = found[0] if found else ""
        self._choose_columns()

    def _choose_columns(self) -> None:
        """The columns of the table, and the first of them if none of those chosen is in it."""
        path = self._table()
        names = curves.columns_of(path) if path else []
        if names != self.state.all_columns:
            self.state.all_columns = names
        if not set(self.state.columns or []) & set(names):
            self.state.columns = names[:1]
        self._draw_curves()

    def _table(self) -> Path | None:
        folder = self.results.folder if self.results else self.run.out if self.run else None
        return curves.tables_of(folder).get(self.state.table) if folder else None

    def _draw_curves(self) -> None:
        path = self._table()
        self.state.chart = curves.chart(path, self.state.columns or [], (660, 190)) if path else ""

    # A click that does not drag picks; with the shift key what is there is dragged.

    def _press(self, *_) -> None:
        self._pressed = self.interactor.GetEventPosition()
        if self.state.mode == "case" and self.interactor.GetShiftKey():
            path = self.view.grab(*self._pressed)
            if moving.owner(self.document, path):
                self._dragged, self._style = path, self.interactor.GetInteractorStyle()
                self.interactor.SetInteractorStyle(vtkInteractorStyleUser())  # one that keeps the camera

    def _drag(self, *_) -> None:
        if self._dragged:
            self.view.drag(*self.interactor.GetEventPosition(), self._dragged)
            self._push()

    def _drop(self, *_) -> None:
        if not self._dragged:
            return
        path, self._dragged = self._dragged, ""
        self.interactor.SetInteractorStyle(self._style)
        shift, grid = self.view.drag(*self.interactor.GetEventPosition(), path), moving.grid_of(self.view.size)
        with self.state:
            self.state.selected = path
            self._edit(lambda: moving.move(self.document, path, shift, grid))

    def _release(self, *_) -> None:
        at = self.interactor.GetEventPosition()
        if self.state.mode == "case" and np.abs(np.subtract(at, self._pressed)).max() <= 2:
            path = self.view.pick(*at)
            if path and self.document.get(path) is not None:
                with self.state:
                    self.select(path)

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
