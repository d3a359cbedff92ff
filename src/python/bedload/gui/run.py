"""Checks and runs of a case in processes of their own, so that the window stays quick and survives them."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CaseError, DeviceError, FileError, SimulationFault

PARTICLES = 200_000  # of a kind that are sent to be seen
LATER = 0.25  # s between two reports of a run
REST = 10  # so many times as long as particles took to arrive, no others are asked for


FIRST = ("particles", "memory", "steps", "run time", "device", "step", "substep")  # what is asked first of a check


class Check:
    """`bedload check FILE --preview FOLDER` while it works, and what it printed."""

    def __init__(self, file: str | Path, preview: str | Path):
        self.preview = Path(preview)
        words = [sys.executable, "-m", "bedload", "check", str(file), "--preview", str(preview)]
        self._process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self._text: str | None = None

    def poll(self) -> bool:
        """Whether it has ended."""
        if self._text is None and self._process.poll() is not None:
            self._text = self._process.communicate()[0]
        return self._text is not None

    def cancel(self) -> None:
        if not self.poll():
            self._process.kill()
            self._text = self._process.communicate()[0]

    @property
    def passed(self) -> bool:
        return self._process.returncode == 0

    @property
    def text(self) -> str:
        """What it printed."""
        return (self._text or "").strip()

    def rows(self) -> list[tuple[str, str]]:
        """What it printed, line by line: what a line is about ("memory") and what it says; the most asked first."""
        found: list[tuple[str, str]] = []
        for line in self.text.splitlines():
            if line.startswith("warning: "):
                found.append(("warning", line[9:]))
            elif line[:1].isspace() and found:
                found.append(("", line.strip()))
            elif line != "case OK":
                about, says = (line[:11], line[11:]) if line[10:11] == " " else ("", line)
                found.append((about.strip(), says.strip()))
        about = ""
        placed = []  # each line with those that continue it
        for row in found:
            about = row[0] or about
            placed.append((FIRST.index(about) if about in FIRST else len(FIRST), row))
        return [row for _, row in sorted(placed, key=lambda one: one[0]) if row[0] not in ("case", "preview")]


@dataclass
class Progress:
    """What a run last reported."""

    state: str = "starting"  #: "running", "paused"; at its end "completed", "stopped" or "failed"
    message: str = ""  #: why it failed
    time: float = 0.0  #: simulated, s
    end: float = 0.0  #: s
    step: int = 0
    dt: float = 0.0  #: s
    limit: str = ""  #: what limits dt
    rate: float = 0.0  #: steps/s
    counts: tuple[int, int, int] = (0, 0, 0)  #: fluid, walls, grains

    @property
    def ended(self) -> bool:
        return self.state in ("completed", "stopped", "failed")

    @property
    def seconds_left(self) -> float:
        """At the present rate; infinite before it is known."""
        return (self.end - self.time) / (self.rate * self.dt) if self.rate * self.dt > 0 else np.inf


@dataclass
class Cloud:
    """Particles of one kind: positions [n, 3] in m, fields by name, their units."""

    position: np.ndarray
    fields: dict[str, np.ndarray] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)


class LiveRun:
    """A run in a process of its own, that can be paused, resumed, stopped and looked at."""

    def __init__(self, file: str | Path, out: str | Path, *, restart: bool = False, overwrite: bool = False,
                 allow_changes: bool = False, backend: str = "auto", threads: int = 0):
        self.out = Path(out)
        self.progress = Progress()
        self.clouds: dict[str, Cloud] = {}
        self.seen = 0  #: how often particles have arrived
        self.first_walls: Cloud | None = None  #: before the first step
        self._asked: float | None = None  # when, s
        self._rest_until = 0.0  # s
        spawn = multiprocessing.get_context("spawn")
        self._pipe, other = spawn.Pipe()
        options = {"restart": "latest" if restart else None, "overwrite": overwrite,
                   "allow_changes": allow_changes, "backend": backend, "threads": threads}
        self._process = spawn.Process(target=_work, args=(other, str(file), str(out), options), daemon=True)
        self._process.start()
        other.close()

    def poll(self) -> Progress:
        """Takes in what has been reported since, and returns the progress."""
        try:
            while self._pipe.poll():
                kind, what = self._pipe.recv()
                if kind == "progress":
                    self.progress = what
                else:
                    if not self.seen:
                        self.first_walls = what.get("walls")
                    self.clouds, self.seen = what, self.seen + 1
                    if self._asked is not None:
                        now = time.monotonic()
                        self._asked, self._rest_until = None, now + REST * (now - self._asked)
        except (EOFError, OSError):
            pass
        if not self._process.is_alive() and not self.progress.ended and not self._pipe_has_more():
            self.progress.state, self.progress.message = "failed", "the process of the run has died"
        return self.progress

    def pause(self) -> None:
        self._tell("pause")

    def resume(self) -> None:
        self._tell("resume")

    def stop(self) -> None:
        """Ends it after this step; it writes its last frame, a checkpoint and summary.json."""
        if self.progress.state == "starting":
            self._process.terminate()
            self.progress.state, self.progress.message = "stopped", "stopped before t = 0"
        self._tell("stop")

    def look(self) -> None:
        """Asks for the particles as they are now, unless that would slow the run; they arrive in `clouds`."""
        rested = self._asked is None and time.monotonic() >= self._rest_until
        if rested and self.progress.state in ("running", "paused"):
            self._asked = time.monotonic()
            self._tell("look")

    def wait(self, seconds: float) -> Progress:
        """Polls until it has ended, at most so long."""
        until = time.monotonic() + seconds
        while not self.poll().ended and time.monotonic() < until:
            time.sleep(0.02)
        return self.progress

    def _pipe_has_more(self) -> bool:
        try:
            return self._pipe.poll()
        except OSError:
            return False

    def _tell(self, command: str) -> None:
        try:
            self._pipe.send(command)
        except (BrokenPipeError, OSError):
            pass


def clouds_of_frame(run: Any, frame: int, stores: tuple[str, ...] = ("fluid", "grains")) -> dict[str, Cloud]:
    """A frame of a results folder. run: `bedload.open_run(...)`."""
    found = {}
    for store in stores:
        if not (run.folder / f"{store}.vtkhdf").exists():
            continue
        frames = getattr(run, store)
        names = [name for name in frames.names() if name != "position"]
        found[store] = Cloud(frames.position(frame), {name: frames.read(frame, name) for name in names},
                             {name: frames.unit(name) for name in names})
    return found


def _work(pipe: Any, file: str, out: str, options: dict[str, Any]) -> None:
    """The process of a run."""
    import signal

    from ..simulation import Simulation

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of the terminal; the window tells it to stop
    progress = Progress()
    try:
        simulation = Simulation(file, out, **options)
        progress.state, progress.end, progress.time = "running", simulation.end, simulation.time
        _steps(pipe, simulation, progress)
        simulation.close()
        progress.state = "completed" if simulation.time >= simulation.end else "stopped"
    except (CaseError, FileError, DeviceError, SimulationFault) as error:
        progress.state, progress.message = "failed", str(error)
    except MemoryError:
        progress.state, progress.message = "failed", "out of memory; see the estimate of Check"
    try:
        pipe.send(("progress", progress))
    except (BrokenPipeError, OSError):
        pass


def _steps(pipe: Any, simulation: Any, progress: Progress) -> None:
    """Steps to the end, or until the window says stop or is gone."""
    reported, steps = 0.0, simulation.step_count

    def report():
        nonlocal reported, steps
        now = time.monotonic()
        if progress.state == "running" and reported:
            progress.rate = (simulation.step_count - steps) / (now - reported)
        reported, steps = now, simulation.step_count
        progress.time, progress.step, progress.counts = simulation.time, steps, tuple(simulation._run.counts)
        pipe.send(("progress", progress))

    report()
    pipe.send(("particles", _clouds(simulation)))  # with the walls where they are before they move
    while simulation.time < simulation.end:
        while pipe.poll(None if progress.state == "paused" else 0):
            try:
                command = pipe.recv()
            except EOFError:
                command = "stop"
            if command == "stop":
                return
            if command == "look":
                pipe.send(("particles", _clouds(simulation)))
            else:
                progress.state = "paused" if command == "pause" else "running"
                report()
        info = simulation.step()
        progress.dt, progress.limit = info.dt, info.limit
        if time.monotonic() - reported > LATER:
            report()
    report()


def _clouds(simulation: Any) -> dict[str, Cloud]:
    found = {}
    for store in ("fluid", "grains", "walls"):
        arrays = simulation._run.snapshot(store)
        if "position" not in arrays or not len(arrays["position"][0]):
            continue
        every = -(-len(arrays["position"][0]) // PARTICLES)
        kept = arrays["id"][0] % every == 0  # the same ones each time
        some = {name: (array[kept].astype(np.float32 if array.dtype == float else array.dtype), unit)
                for name, (array, unit) in arrays.items()}
        found[store] = Cloud(some.pop("position")[0], {name: array for name, (array, _) in some.items()},
                             {name: unit for name, (_, unit) in some.items()})
    return found
