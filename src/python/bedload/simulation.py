"""Runs in this process, step by step."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Iterator, Sequence

import numpy as np

from ._module import module
from .case import Case, checked_ranks, devices_text
from .errors import CaseError, SimulationFault


class DeviceArray:
    """An array in the memory of a GPU, for CuPy, PyTorch, Numba: `cupy.asarray(a)`, `torch.from_dlpack(a)`.

    Read-only, and like arrays of the CPU valid until the next step. NumPy functions and indexing each make a copy in
    host memory.
    """

    def __init__(self, field: Any):
        self._field = field
        self.shape: tuple[int, ...] = field.shape
        self.dtype = np.dtype(field.kind)
        self.__cuda_array_interface__ = {"shape": field.shape, "typestr": field.kind, "data": (field.pointer, True),
                                         "strides": field.strides, "stream": None,  # the solver has been waited for
                                         "version": 3}

    def copy(self) -> np.ndarray:
        """What it holds now, in host memory."""
        return self._field.copy()

    def __dlpack__(self, **options: Any) -> Any:
        return self._field.exporter().__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[int, int]:
        return self._field.exporter().__dlpack_device__()

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        if copy is False:
            raise ValueError("NumPy needs a copy of an array in the memory of a GPU")
        return self.copy().astype(dtype or self.dtype, copy=False)

    def __getitem__(self, index: Any) -> Any:
        return self.copy()[index]

    def __len__(self) -> int:
        return self.shape[0]

    def __repr__(self) -> str:
        return f"<DeviceArray of {self.dtype}, {self.shape}>"


class Particles:
    """Fluid, grains or walls of a simulation, in the solver's own order: `simulation.fluid.velocity`.

    Arrays are read-only zero-copy views of the solver's memory, valid until the next step: get them again after it, or
    keep a `.copy()`. (An older array stays valid memory with outdated values.) `fluid.pressure` is computed, so a copy,
    and in single precision so is `fluid.position`. When neighbour lists were rebuilt (`Step.rebuilt`) the order and
    number of particles may change; `id` identifies them.
    """

    def __init__(self, run: Any, store: str):
        self._run, self._store = run, store

    def __len__(self) -> int:
        fluid, walls, grains = self._run.counts
        return {"fluid": fluid, "walls": walls, "grains": grains}[self._store]

    def names(self) -> list[str]:
        """Names of all arrays."""
        return sorted(self._run.fields(self._store).keys() | self._run.snapshot(self._store).keys())

    def unit(self, name: str) -> str:
        """Unit of an array: "m/s"; "-" for a pure number."""
        return self._find(name)[1]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        array = self._find(name)[0]
        return array if isinstance(array, np.ndarray) else DeviceArray(array)

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)

    def copy(self, name: str) -> np.ndarray:
        """A copy in host memory, also of an array on a GPU."""
        return getattr(self, name).copy()

    def by_id(self, name: str) -> np.ndarray:
        """A copy of an array sorted by particle id, an order that is stable while the particles stay the same."""
        return self.copy(name)[np.argsort(self.copy("id"))]

    def __dir__(self):
        return [*object.__dir__(self), *self.names()]

    def __repr__(self) -> str:
        return f"<{self._store}: {len(self)} particles; {', '.join(self.names())}>"

    def _find(self, name: str) -> tuple[Any, str]:
        for arrays in (self._run.fields, self._run.snapshot):
            found = arrays(self._store)
            if name in found:
                return found[name]
        raise AttributeError(f"{self._store} has no array '{name}', only {', '.join(self.names())}")


class Simulation:
    """A run in this process.

    case: a Case or the name of a file. out: folder of results, as `bedload run --out`; without one nothing is written.
    restart: a checkpoint, or "latest" of `out`. backend: "cpu", "cuda" or "auto". threads: 0 for all.
    devices: GPUs that divide the particles, a number of them, a list of their numbers or "all"; ranks: parts of the
    CPU that do. Particles are then in the order of one GPU, and their arrays are copies.
    overwrite: replaces an existing run in `out`. allow_changes: restarts with a modified case. Grains settle here,
    if the case says so. Raises CaseError, FileError, DeviceError, SimulationFault.

    Use it in a `with` block, or call `close()`, which writes the last frame, checkpoint and summary.json. Several
    simulations may exist at once; one at a time computes.
    """

    def __init__(self, case: Case | str | Path, out: str | Path | None = None, *, restart: str | Path | None = None,
                 backend: str = "auto", threads: int = 0, overwrite: bool = False, allow_changes: bool = False,
                 devices: int | str | Sequence[int] | None = None, ranks: int = 1):
        self.case: Case = case if isinstance(case, Case) else Case(case)  #: that it runs
        self.out: Path | None = None if out is None else Path(out)  #: folder of results
        if restart == "":
            raise CaseError("restart is empty; it must be a checkpoint, \"latest\" or None for a new run")
        if restart == "latest":
            if self.out is None:
                raise CaseError("restart = \"latest\" needs `out`, whose newest checkpoint it takes")
            restart = module().latest_checkpoint(self.out)
        read = self.case._read(restart or "")
        self._run = module().Run(read, self.out or "", restart or "", backend, threads, overwrite, allow_changes,
                                devices_text(devices), checked_ranks(ranks))
        self._begun = self._ended = False
        self.fluid: Particles = Particles(self._run, "fluid")  #: its arrays
        self.grains: Particles = Particles(self._run, "grains")  #: its arrays
        self.walls: Particles = Particles(self._run, "walls")  #: its arrays

    # -- running --------------------------------------------------------------------------------

    def step(self):
        """Makes one step and writes the results that are due; returns a `Step`."""
        if self._ended:
            raise CaseError("this simulation is closed")
        try:
            self._begin()
            return self._run.step()
        except SimulationFault:
            self._finish("failed")
            raise

    def steps(self, until: float | None = None) -> Iterator[Any]:
        """Steps one by one until a time, s; without one to the case's time.end."""
        end = self.end if until is None else until
        self._begin()
        while self.time < end:
            yield self.step()

    def run(self, until: float | None = None, *, every: float | None = None,
            call: Callable[[Simulation], Any] | None = None) -> None:
        """Runs until a time, s; without one to the case's time.end.

        Calls `call(self)` after each step, or with `every` (s) at the start and at the first step end at or after each
        multiple of it. Stops where it returns False.
        """
        def multiple() -> int:
            return self.step_count if every is None else int(np.floor(self.time / every + 1e-9))

        if every is not None and not every > 0:
            raise CaseError(f"every = {every} must be > 0")
        called = multiple()
        if call and every is not None and call(self) is False:
            return
        for _ in self.steps(until):
            if call and multiple() > called:
                called = multiple()
                if call(self) is False:
                    return

    def checkpoint(self) -> Path:
        """Saves the state in the results folder now; returns the file."""
        self._begin()
        return self._run.checkpoint()

    def close(self) -> None:
        """Writes the last frame, checkpoint and summary.json. Arrays can still be read."""
        if not self._ended:
            self._begin()
            self._finish("completed" if self.time >= self.end else "stopped")

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    # -- state ---------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """s."""
        return self._run.time

    @property
    def end(self) -> float:
        """The case's time.end, s."""
        return self._run.end

    @property
    def step_count(self) -> int:
        """Steps done."""
        return self._run.steps

    @property
    def warnings(self) -> list[str]:
        """A sentence each."""
        return self._run.warnings

    @property
    def memory(self) -> int:
        """Memory of the solver, bytes."""
        return self._run.bytes

    def diagnostics(self) -> dict[str, float]:
        """Masses, momenta, energies, extremes, counters, as in diagnostics.csv, in SI units."""
        return _values(self._run.diagnostics())

    def probe(self, name: str) -> dict[str, float]:
        """Current values of a probe in SI units; for a force with sample = "mean" the mean since its last row."""
        return _values(self._run.measure(name))

    def body(self, name: str) -> dict[str, float]:
        """Position, velocity, forces and their power of a wall body, in SI units."""
        return _values(self._run.body(name))

    def units(self) -> dict[str, str]:
        """Units of the diagnostics."""
        return {name: unit for name, (_, unit) in self._run.diagnostics().items()}

    def step_limits(self) -> dict[str, float]:
        """Limits of the next time step, s."""
        return _values(self._run.limits())

    def ranks(self) -> list[dict[str, float]]:
        """Of each rank: fluid, walls, grains and ghosts (particles), bytes, and so far exchanges, migrated
        particles, bytes sent and seconds waited for others. Empty if the particles are not divided."""
        return self._run.ranks()

    def time_spent(self) -> dict[str, float]:
        """Wall time by part, over all steps, s."""
        return _values(self._run.time_spent())

    def __repr__(self) -> str:
        fluid, walls, grains = self._run.counts
        return (f"<Simulation at t = {self.time:.6g} s of {self.end:.6g} s: {fluid} fluid, {walls} wall particles, "
                f"{grains} grains>")

    def _begin(self) -> None:
        if not self._begun:
            self._begun = True
            self._run.begin()

    def _finish(self, status: str) -> None:
        self._ended = True
        self._run.finish(status)


def _values(found: dict[str, tuple[float, Any]]) -> dict[str, float]:
    return {name: value for name, (value, _) in found.items()}
