"""Derived quantities of particles: maps, mixing, bed outline, mills, power, residence time, contacts. Arrays come from
frames (`run.grains.position(k)`) or from a simulation (`s.grains.position`).

SI units; positions [n, 3].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np

_SAMPLES = 8  # points along the diameter for spreading a sphere over cells


@dataclass
class Grid:
    """Cells over a box: `Grid.over(low, high, cell)`."""

    low: np.ndarray  #: lower corner, m
    cell: np.ndarray  #: sides of a cell, m
    shape: tuple[int, int, int]  #: number of cells along x, y, z

    @classmethod
    def over(cls, low: Sequence[float], high: Sequence[float], cell: float | Sequence[float]) -> Grid:
        """Cells of about side `cell` (m, one number or three) that fill the box from `low` to `high`."""
        low, high = np.asarray(low, float), np.asarray(high, float)
        if not np.all(high > low):
            raise ValueError(f"high = {high.tolist()} must exceed low = {low.tolist()} on every axis")
        counts = np.maximum(1, np.round((high - low) / np.broadcast_to(cell, 3))).astype(int)
        return cls(low, (high - low) / counts, tuple(int(n) for n in counts))

    @property
    def volume(self) -> float:
        """Volume of a cell, m3."""
        return float(np.prod(self.cell))

    def centres(self, axis: int) -> np.ndarray:
        """Centres of the cells along an axis, m."""
        return self.low[axis] + (np.arange(self.shape[axis]) + 0.5) * self.cell[axis]

    def edges(self, axis: int) -> np.ndarray:
        """Edges of the cells along an axis, m."""
        return self.low[axis] + np.arange(self.shape[axis] + 1) * self.cell[axis]

    def index(self, x: np.ndarray) -> np.ndarray:
        """Index of the cell of each position, in C order; -1 outside."""
        at = np.floor((np.asarray(x, float) - self.low) / self.cell).astype(int)
        inside = np.all((at >= 0) & (at < self.shape), axis=-1)
        at = np.moveaxis(np.where(inside[..., None], at, 0), -1, 0)
        return np.where(inside, np.ravel_multi_index(at, self.shape), -1)

    def sum(self, x: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Sums of `weight` over the cells, [nx, ny, nz]; points outside are ignored."""
        at = self.index(x).ravel()
        inside = at >= 0
        weight = np.broadcast_to(weight, np.shape(x)[:-1]).ravel()
        return np.bincount(at[inside], weight[inside], int(np.prod(self.shape))).reshape(self.shape)


def solid_fraction_map(grid: Grid, x: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Solid fraction of each cell, [nx, ny, nz]: spheres are spread over cells, which conserves their volume."""
    x, radius = np.asarray(x, float), np.broadcast_to(np.asarray(radius, float), len(x))
    line = (np.arange(_SAMPLES) + 0.5) / _SAMPLES * 2 - 1
    points = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1).reshape(-1, 3)
    points = points[np.sum(points**2, axis=1) < 1]
    weight = 4 / 3 * np.pi * radius**3 / len(points)
    filled = np.zeros(grid.shape)
    for point in points:
        filled += grid.sum(x + radius[:, None] * point, weight)
    return filled / grid.volume


def porosity_map(grid: Grid, x: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """1 - `solid_fraction_map`."""
    return 1 - solid_fraction_map(grid, x, radius)


def mean_map(grid: Grid, x: np.ndarray, value: np.ndarray, weight: np.ndarray | float = 1.0) -> np.ndarray:
    """Weighted mean of a value [n] or [n, 3] of the particles in each cell; NaN for empty cells.

    With velocities, and masses as weights, it is the velocity map.
    """
    value = np.asarray(value, float)
    columns = value.reshape(len(value), -1)
    weight = np.broadcast_to(np.asarray(weight, float), len(value))
    total = grid.sum(x, weight)
    with np.errstate(invalid="ignore", divide="ignore"):
        means = np.stack([grid.sum(x, weight * column) / total for column in columns.T], axis=-1)
    return means[..., 0] if value.ndim == 1 else means


def lacey_index(grid: Grid, x: np.ndarray, kind: np.ndarray, least: int = 5) -> float:
    """How well two kinds of grains are mixed: 0 apart, 1 as if at random [lacey54].

    kind: True or 1 for one kind. Cells are the samples; those of fewer than `least` grains do not count, the others by
    their number of grains. (S0^2 - S^2) / (S0^2 - Sr^2), with S0^2 = p (1 - p) apart and Sr^2 = S0^2 / n at random.
    """
    kind = np.asarray(kind, float)
    number, of_kind = grid.sum(x, 1.0).ravel(), grid.sum(x, kind).ravel()
    used = number >= least
    if not used.any():
        raise ValueError(f"no cell holds {least} grains; take larger cells")
    n, p = number[used], of_kind[used].sum() / number[used].sum()
    apart = p * (1 - p)
    if apart == 0:
        raise ValueError("all grains are of one kind")
    variance = np.average((of_kind[used] / n - p) ** 2, weights=n)
    at_random = apart * np.average(1 / n, weights=n)
    return float((apart - variance) / (apart - at_random))


def segregation_intensity(grid: Grid, x: np.ndarray, value: np.ndarray, weight: np.ndarray | float = 1.0) -> float:
    """Intensity of segregation [danckwerts52]: variance of the cells' means over that of the particles; 1 apart.

    value: of each particle, such as its radius, or 1 and 0 for two kinds.
    """
    value, weight = np.asarray(value, float), np.broadcast_to(np.asarray(weight, float), len(value))
    inside = grid.index(x) >= 0
    x, value, weight = np.asarray(x)[inside], value[inside], weight[inside]
    mean = np.average(value, weights=weight)
    variance = np.average((value - mean) ** 2, weights=weight)
    if variance == 0:
        raise ValueError("all particles have the same value")
    total, means = grid.sum(x, weight), mean_map(grid, x, value, weight)
    filled = total > 0
    return float(np.average((means[filled] - mean) ** 2, weights=total[filled]) / variance)


def bed_surface(grid: Grid, fraction: np.ndarray, up: int = 2, filled: float = 0.3) -> np.ndarray:
    """Height of the bed over the other two axes, m: top of the highest cell whose solid fraction exceeds `filled`.

    fraction: of `solid_fraction_map`. NaN where there is no bed.
    """
    bed = np.moveaxis(fraction > filled, up, -1)
    top = bed.shape[-1] - 1 - np.argmax(bed[..., ::-1], axis=-1)
    return np.where(bed.any(axis=-1), grid.low[up] + (top + 1) * grid.cell[up], np.nan)


def bed_outline(x: np.ndarray, radius: np.ndarray, along: int, up: int, cell: float) -> np.ndarray:
    """Outline of the bed seen from the side: [m, 2] of position along an axis and height of the grains there, m."""
    x, radius = np.asarray(x, float), np.broadcast_to(np.asarray(radius, float), len(x))
    low, high = (x[:, along] - radius).min(), (x[:, along] + radius).max()
    place = np.arange(low + cell / 2, high, cell)
    top = np.full(len(place), -np.inf)
    first = np.maximum(np.ceil((x[:, along] - radius - place[0]) / cell).astype(int), 0)
    last = np.minimum(np.floor((x[:, along] + radius - place[0]) / cell).astype(int), len(place) - 1)
    for step in range(int((last - first).max()) + 1):
        k = first + step
        own = k <= last
        away = place[k[own]] - x[own, along]
        height = x[own, up] + np.sqrt(np.maximum(radius[own] ** 2 - away**2, 0))
        np.maximum.at(top, k[own], height)
    there = np.isfinite(top)
    return np.stack([place[there], top[there]], axis=1)


def surface_slope(outline: np.ndarray) -> float:
    """Angle of the straight line through an outline, by least squares, degrees."""
    return float(np.degrees(np.arctan(np.polyfit(outline[:, 0], outline[:, 1], 1)[0])))


def toe_and_shoulder(x: np.ndarray, radius: np.ndarray, centre: Sequence[float], axis: Sequence[float], shell: float,
                     *, frames: int = 1, filled: float = 0.3, band: float | None = None, sectors: int = 72,
                     up: Sequence[float] = (0, 0, 1)) -> tuple[float, float]:
    """Angles of a mill's charge, degrees: the toe, where it begins at the shell, and the shoulder, where it leaves it.

    Both are counted from the lowest point of the shell, positive the way the mill turns. x, radius: of the grains [n],
    or of those of several `frames` one behind another, for the mean over them. centre: a point on the axis, m; axis:
    direction of the axis, the mill turning right-handed about it; shell: inner radius of the shell, m.

    The ring between the shell and `band` (m; default two diameters of the largest grain) within it is divided into
    `sectors`; the charge reaches from the fullest one both ways as far as the solid fraction exceeds `filled`, linear
    between the middles of sectors. Grains in flight hardly count; lifters lower the fraction a little.
    """
    x, radius = np.asarray(x, float) - np.asarray(centre, float), np.broadcast_to(np.asarray(radius, float), len(x))
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    down = -np.asarray(up, float)
    down -= (down @ axis) * axis
    if np.linalg.norm(down) < 1e-6:
        raise ValueError("the axis of a mill must not be vertical")
    down /= np.linalg.norm(down)
    band = 4 * radius.max() if band is None else band
    along, r = x @ axis, np.linalg.norm(x - np.outer(x @ axis, axis), axis=1)
    length = (along + radius).max() - (along - radius).min()
    angle = np.degrees(np.arctan2(x @ np.cross(axis, down), x @ down))
    near = (r > shell - band) & (r <= shell)
    at = np.floor((angle[near] + 180) / 360 * sectors).astype(int) % sectors
    ring = np.pi * (shell**2 - (shell - band) ** 2) * length / sectors
    fraction = np.bincount(at, 4 / 3 * np.pi * radius[near] ** 3, sectors) / (ring * frames)
    if fraction.max() <= filled:
        raise ValueError(f"no charge at the shell: the solid fraction there is {fraction.max():.2g} at most")
    if fraction.min() > filled:
        raise ValueError("the charge lines the whole shell: it has neither toe nor shoulder")
    first = int(fraction.argmax())

    def end(way: int) -> float:
        k = next(k for k in range(1, sectors) if fraction[(first + way * k) % sectors] <= filled)
        inner, outer = fraction[(first + way * (k - 1)) % sectors], fraction[(first + way * k) % sectors]
        place = first + way * (k - 1 + (inner - filled) / (inner - outer))
        return float(((place + 0.5) / sectors * 360) % 360 - 180)

    return end(-1), end(1)


def contact_pairs(x: np.ndarray, radius: np.ndarray, gap: float = 0.0,
                  period: Sequence[float] | None = None) -> np.ndarray:
    """Pairs [m, 2] of grains whose surfaces are no farther apart than `gap`, m, each once.

    period: length of the domain along each axis, m; 0 where it is not periodic.
    """
    x, radius = np.asarray(x, float), np.broadcast_to(np.asarray(radius, float), len(x))
    if len(x) < 2:
        return np.zeros((0, 2), int)
    period = np.zeros(3) if period is None else np.asarray(period, float)
    found = []
    for i, j, apart in _near(x, x, 2 * radius.max() + gap, period):
        touch = (i < j) & (np.sum(apart**2, axis=1) <= (radius[i] + radius[j] + gap) ** 2)
        found.append(np.stack([i[touch], j[touch]], axis=1))
    return np.unique(np.concatenate(found), axis=0)  # with few cells a neighbour is met by several ways


def _near(at: np.ndarray, x: np.ndarray, reach: float, period: np.ndarray):
    """Of places and particles in cells next to each other: indices of both, and the vectors from particle to place.
    Those nearer than `reach` are among them, some several times."""
    low = x.min(axis=0)
    length = np.where(period > 0, period, x.max(axis=0) - low + 1e-9 * reach)
    cells = np.maximum(1, np.floor(length / reach)).astype(int)
    key = np.ravel_multi_index((np.floor((x - low) / length * cells).astype(int) % cells).T, cells)
    order = np.argsort(key, kind="stable")
    begins = np.searchsorted(key[order], np.arange(np.prod(cells) + 1))
    home = np.floor((at - low) / length * cells).astype(int)
    for shift in np.ndindex(3, 3, 3):
        to = home + np.array(shift) - 1
        valid = np.all(((to >= 0) & (to < cells)) | (period > 0), axis=1)
        other = np.where(valid, np.ravel_multi_index((to % cells).T, cells), 0)
        first, count = begins[other], np.where(valid, begins[other + 1] - begins[other], 0)
        i = np.repeat(np.arange(len(at)), count)
        j = order[np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + np.repeat(first, count)]
        apart = at[i] - x[j]
        apart -= period * np.round(apart / np.where(period > 0, period, 1))
        yield i, j, apart


def coordination(x: np.ndarray, radius: np.ndarray, gap: float = 0.0,
                 period: Sequence[float] | None = None) -> np.ndarray:
    """Coordination number of each grain, [n]; as `contact_pairs`."""
    return np.bincount(contact_pairs(x, radius, gap, period).ravel(), minlength=len(x))


def residence_times(frames: Any) -> tuple[np.ndarray, np.ndarray]:
    """Residence times of particles, s: of those that entered after the first frame and left before the last, and so far
    of those still present. Accurate to the interval of frames."""
    first: dict[int, float] = {}
    last: dict[int, float] = {}
    for k, time in enumerate(frames.times):
        for name in frames.read(k, "id").tolist():
            first.setdefault(name, float(time))
            last[name] = float(time)
    begin, end = float(frames.times[0]), float(frames.times[-1])
    came = [name for name, time in first.items() if time > begin]
    gone = np.array([last[name] - first[name] for name in came if last[name] < end])
    here = np.array([end - first[name] for name in came if last[name] == end])
    return gone, here


def angular_velocity(x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Angular velocity of a rigid body with particles at x and velocities v, by least squares, rad/s, [3]."""
    x, v = np.asarray(x, float), np.asarray(v, float)
    x, v = x - x.mean(axis=0), v - v.mean(axis=0)
    inertia = np.sum(x**2) * np.eye(3) - x.T @ x
    return np.linalg.lstsq(inertia, np.sum(np.cross(x, v), axis=0), rcond=None)[0]


def mean_power(table: Any, column: str | None = None, start: float = 0.0) -> float:
    """Mean over time, from `start` (s) on, of a power in a table of a body, W, by the trapezoidal rule.

    Below zero where the body drives what it meets. Without a column that of fluid, grains and contacts together, of
    what the table has; "power_by_fluid" is that of the fluid alone.
    """
    columns = [column] if column else [name for name in table.names() if name.startswith("power_by_")]
    if not columns:
        raise ValueError(f"{table.path}: has no power, only {', '.join(table.names())}")
    time, power = table.column("time"), sum(table.column(name) for name in columns)
    used = time >= start
    if used.sum() < 2:
        raise ValueError(f"{table.path}: ends at {time[-1]:g} s; fewer than two rows from {start:g} s on")
    time, power = time[used], power[used]
    return float(np.sum(np.diff(time) * (power[1:] + power[:-1]) / 2) / (time[-1] - time[0]))


def power_number(power: float, density: float, turns: float, diameter: float) -> float:
    """Power number P / (rho N^3 D^5) of an impeller: W, kg/m3, 1/s, m."""
    return power / (density * turns**3 * diameter**5)


def _wendland(q: np.ndarray) -> np.ndarray:
    return (1 - q / 2) ** 4 * (1 + 2 * q)


def at_points(run: Any, points: Any, names: Sequence[str] = ("pressure", "velocity"),
              frames: Sequence[int] | None = None) -> dict[str, np.ndarray]:
    """Fields of the fluid at points in the frames of a run, as point probes measure them: by Shepard average.

    points: [m, 3] or a grid [..., 3], m; a side on which the domain is periodic is continued. frames: default all.
    Returns an array for each name, [frames, ...] or [frames, ..., 3], NaN where there are too few particles, and
    "kernel_sum", about 1 within the fluid. Kernel: Wendland C2 with the smoothing length of the case.
    """
    fluid, domain = run.case["fluid"], run.case["domain"]
    dx, flat = float(fluid["dx"]), bool(domain.get("two_d", False))
    h = dx * float(fluid["sigma_h" if fluid.get("variable_h", False) else "h_over_dx"])
    low, high = np.asarray(domain["min"], float), np.asarray(domain["max"], float)
    period = np.where(domain.get("periodic", [False] * 3), high - low, 0.0)
    norm = 7 / (4 * np.pi * h**2) * dx**2 if flat else 21 / (16 * np.pi * h**3) * dx**3
    points = np.asarray(points, float)
    at = points.reshape(-1, 3).copy()
    wanted = range(len(run.fluid)) if frames is None else [range(len(run.fluid))[k] for k in frames]
    out: dict[str, list[np.ndarray]] = {name: [] for name in ("kernel_sum", *names)}
    for frame in wanted:
        x = run.fluid.position(frame)
        if flat:
            x[:, 1] = at[:, 1] = 0
        rho = run.fluid.get(frame, "density", np.full(len(x), float(fluid["rho0"]))) / float(fluid["rho0"])
        i, j = _within(at, x, 2 * h, period)
        apart = at[i] - x[j]
        apart -= period * np.round(apart / np.where(period > 0, period, 1))
        weight = norm / rho[j] * _wendland(np.sqrt(np.sum(apart**2, axis=1)) / h)
        total = np.bincount(i, weight, len(at))
        out["kernel_sum"].append(total.reshape(points.shape[:-1]))
        for name in names:
            value = run.fluid.read(frame, name).astype(float)
            columns = value.reshape(len(x), -1)
            with np.errstate(invalid="ignore", divide="ignore"):
                mean = np.stack([np.bincount(i, weight * c[j], len(at)) / total for c in columns.T], axis=-1)
            mean[total <= 0.05] = np.nan  # too few neighbours for a mean
            out[name].append(mean.reshape(points.shape[:-1] + value.shape[1:]))
    return {name: np.array(values) for name, values in out.items()}


def _within(at: np.ndarray, x: np.ndarray, reach: float, period: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of a place and a particle nearer than `reach`: their indices."""
    pairs = [np.zeros((0, 2), int)]
    if len(x) > 0:
        for i, j, apart in _near(at, x, reach, period):
            near = np.sum(apart**2, axis=1) < reach**2
            pairs.append(np.stack([i[near], j[near]], axis=1))
    i, j = np.unique(np.concatenate(pairs), axis=0).T
    return i, j


def running_mean(time: np.ndarray, value: np.ndarray, width: float) -> np.ndarray:
    """Mean over `width` seconds around each time, by the trapezoidal rule; shorter at both ends of the series."""
    time, value = np.asarray(time, float), np.asarray(value, float)
    if not width > 0:
        raise ValueError(f"width = {width:g} s must be above 0")
    integral = np.concatenate([[0], np.cumsum(np.diff(time) * (value[1:] + value[:-1]) / 2)])
    begin, end = np.maximum(time - width / 2, time[0]), np.minimum(time + width / 2, time[-1])

    def up_to(t: np.ndarray) -> np.ndarray:  # of values that are linear between the times
        k = np.clip(np.searchsorted(time, t, side="right") - 1, 0, len(time) - 2)
        at = np.interp(t, time, value)
        return integral[k] + (t - time[k]) * (value[k] + at) / 2

    if len(time) < 2:
        return value.copy()
    return (up_to(end) - up_to(begin)) / (end - begin)


def spectrum(time: np.ndarray, value: np.ndarray, start: float = -np.inf) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies, Hz, and one-sided spectral density, unit^2/Hz, of a series from `start` (s) on.

    The mean is taken off; values are interpolated to even times and tapered by a Hann window. The integral of the
    density over frequency is the variance.
    """
    time, value = np.asarray(time, float), np.asarray(value, float)
    used = (time >= start) & np.isfinite(value)
    time, value = time[used], value[used]
    if len(time) < 8:
        raise ValueError(f"a spectrum needs 8 values or more; there are {len(time)}")
    even = np.linspace(time[0], time[-1], len(time))
    step = even[1] - even[0]
    series = np.interp(even, time, value)
    window = np.hanning(len(even))
    density = 2 * step / np.sum(window**2) * np.abs(np.fft.rfft((series - series.mean()) * window)) ** 2
    return np.fft.rfftfreq(len(even), step)[1:], density[1:]
