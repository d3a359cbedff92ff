"""The picture of a window: the case, particles of its check, of a run or of a frame; curves of tables."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import numpy as np

from .._surfaces import metres
from . import curves, scene
from .run import Cloud, clouds_of_frame
from .view import NONE, Look, limits_of, moved_bodies, values_of, write_film


class Drawing:
    """What a `Window` shows, and pictures and films of it."""

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

    # -- curves ----------------------------------------------------------------------------------

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
