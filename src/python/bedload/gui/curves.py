"""Curves of the tables of a run, as SVG."""

from __future__ import annotations

import html
import math
from pathlib import Path
from typing import Sequence

import numpy as np

from ..errors import FileError
from ..results import Table

COLOURS = ("#2f6f9f", "#c9772d", "#3f8f5f", "#8657b5", "#b8434e", "#5f6b76")
MOST = 600  # points of a curve
LEFT, RIGHT, TOP, BOTTOM = 64, 12, 26, 34


def tables_of(folder: str | Path) -> dict[str, Path]:
    """The tables of a results folder by what they are called: "probe front", "body drum", "diagnostics"."""
    folder = Path(folder)
    found = {f"probe {path.stem}": path for path in sorted((folder / "probes").glob("*.csv"))}
    found |= {f"body {path.stem}": path for path in sorted((folder / "bodies").glob("*.csv"))}
    if (folder / "diagnostics.csv").exists():
        found["diagnostics"] = folder / "diagnostics.csv"
    return found


def columns_of(path: str | Path) -> list[str]:
    """The columns of a table that can be drawn over its first one, the time."""
    try:
        return Table(path).numeric()[1:]
    except FileError:
        return []


def chart(path: str | Path, columns: Sequence[str], size: tuple[int, int] = (640, 220)) -> str:
    """Columns of one table over time, as SVG; empty while there is nothing to draw."""
    try:
        table = Table(path)
        names = table.numeric()
    except FileError:
        return ""
    columns = [name for name in columns if name in names[1:]]
    if not columns or not len(table):
        return ""
    every = -(-len(table) // MOST)
    x = table.column(names[0])[::every]
    return svg(x, {name: table.column(name)[::every] for name in columns}, names[0], size)


def svg(x: np.ndarray, curves: dict[str, np.ndarray], x_title: str, size: tuple[int, int]) -> str:
    """Curves over x, with axes, ticks and a legend."""
    width, height = size
    known = np.concatenate([y[np.isfinite(y)] for y in curves.values()])
    if not len(known):
        return ""
    x0, x1 = _limits(float(np.min(x)), float(np.max(x)))
    y0, y1 = _limits(float(known.min()), float(known.max()))

    def across(value):
        return LEFT + (value - x0) / (x1 - x0) * (width - LEFT - RIGHT)

    def down(value):
        return height - BOTTOM - (value - y0) / (y1 - y0) * (height - TOP - BOTTOM)

    out = [f'<svg viewBox="0 0 {width} {height}" width="100%" height="100%" xmlns="http://www.w3.org/2000/svg" '
           'font-family="Roboto, Arial, sans-serif" font-size="11" fill="#44515c">']
    for tick in ticks(y0, y1, 4):
        out.append(f'<line x1="{LEFT}" x2="{width - RIGHT}" y1="{down(tick):.1f}" y2="{down(tick):.1f}" '
                   'stroke="#e1e7ec"/>'
                   f'<text x="{LEFT - 6}" y="{down(tick) + 4:.1f}" text-anchor="end">{tick:.4g}</text>')
    for tick in ticks(x0, x1, 6):
        out.append(f'<line x1="{across(tick):.1f}" x2="{across(tick):.1f}" y1="{TOP}" y2="{height - BOTTOM}" '
                   'stroke="#e1e7ec"/>'
                   f'<text x="{across(tick):.1f}" y="{height - BOTTOM + 14}" text-anchor="middle">{tick:.4g}</text>')
    out.append(f'<text x="{(LEFT + width) / 2}" y="{height - 5}" text-anchor="middle">{html.escape(x_title)}</text>')
    at = LEFT
    for (name, y), colour in zip(curves.items(), COLOURS * len(curves)):
        seen = np.isfinite(y)
        points = " ".join(f"{across(a):.1f},{down(b):.1f}" for a, b in zip(x[seen], y[seen]))
        out.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.6"/>'
                   f'<rect x="{at}" y="9" width="12" height="3" fill="{colour}"/>'
                   f'<text x="{at + 16}" y="14">{html.escape(name)}</text>')
        at += 30 + 6.2 * len(name)
    return "".join(out) + "</svg>"


def ticks(low: float, high: float, about: int) -> list[float]:
    """Round numbers within two limits, roughly so many."""
    rough = (high - low) / about
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * k for k in (1, 2, 5, 10) if power * k >= rough * 0.999)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def _limits(low: float, high: float) -> tuple[float, float]:
    if high > low:
        return low, high
    half = abs(low) * 0.05 or 1.0
    return low - half, high + half
