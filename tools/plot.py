#!/usr/bin/env python3
"""Pictures of a run.

    plot.py frames RUN_DIR --times 0.05,0.1 --out PNG [--field speed] [--slice Y] [--view xz]
    plot.py probe CSV... --out PNG [--column NAME] [--mean SECONDS] [--spectrum] [--reference CSV ...]
    plot.py scaling JSON --out PNG
    plot.py drag-laws CSV... --out PNG

`frames` shows fluid coloured by a field, grains as discs true to size, and the walls, one panel per
time. `probe` draws columns of probe tables over time, with reference points as markers; with --mean their running
means, with --spectrum their spectral density over frequency. `scaling` draws what
`bedload bench --devices 1,2,4 --json JSON` (or --ranks) wrote: speed-up, efficiency and waits over the number of ranks.
`drag-laws` draws what `bedload drag` wrote beside its table: measured drag and each law, one panel per solid fraction.
"""

import argparse
import json
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import EllipseCollection, LineCollection  # noqa: E402
from matplotlib.patches import Rectangle  # noqa: E402

import outlines  # noqa: E402
from frames import Table, running_mean, spectrum  # noqa: E402
from scene import Scene  # noqa: E402

FIELDS = {
    "speed": ("velocity", "speed (m/s)", "viridis"),
    "pressure": ("pressure", "pressure (Pa)", "cividis"),
    "porosity": ("porosity", "porosity (-)", "Blues"),
    "density": ("density", "density (kg/m3)", "cividis"),
}
GRAIN_FILL, GRAIN_EDGE, WALL = "#d98e4a", "#5b3416", "#9a9a9a"
FACES = ["x-", "x+", "y-", "y+", "z-", "z+"]


class Run(Scene):
    """A run folder seen along one axis."""

    def __init__(self, folder, view):
        super().__init__(folder)
        self.across, self.up = ("xyz".index(axis) for axis in view)
        self.depth = 3 - self.across - self.up
        self.nearer = -1 if view == "xz" else 1  # direction of the viewer along the depth

    def fluid(self, time, field, cut):
        """Places [n, 2], disc diameters [n] and values [n] of the fluid near `time`, far ones first.

        The discs are a little wider than dx, so that the fluid reads as one body.
        """
        frames = self.frames["fluid"]
        k = frames.nearest(time)
        values = frames.get(k, FIELDS[field][0])
        if values is None:
            raise SystemExit(f"{frames.path}: has no {FIELDS[field][0]}, only {', '.join(frames.names())}")
        if values.ndim > 1:
            values = np.linalg.norm(values, axis=1)
        x = frames.position(k)
        shown = np.abs(x[:, self.depth] - cut) <= 0.6 * self.dx if cut is not None else np.ones(len(x), bool)
        order = np.flatnonzero(shown)
        order = order[np.argsort(self.nearer * x[order, self.depth], kind="stable")]
        return x[order][:, [self.across, self.up]], np.full(len(order), 1.15 * self.dx), values[order]

    def grains(self, time, cut):
        """Places [n, 2] and diameters [n] of the grains, far ones first; of their cut if there is one."""
        frames = self.frames["grains"]
        k = frames.nearest(time)
        x, radius = frames.position(k), self.radii(k)
        if cut is not None:
            off = np.abs(x[:, self.depth] - cut)
            keep = off < radius
            x, radius = x[keep], np.sqrt(radius[keep] ** 2 - off[keep] ** 2)
        order = np.argsort(self.nearer * x[:, self.depth], kind="stable")
        return x[order][:, [self.across, self.up]], 2 * radius[order]

    def window(self, times):
        """Lower and upper corner of what is worth showing, m."""
        points = [np.array([low, high]) for body, low, high in self.boxes(0) if body["shape"] == "tank"]
        points += [mesh.vertices for mesh in self.meshes(0)]
        shown = list(self.frames.values()) if not points else [f for n, f in self.frames.items() if n == "grains"]
        points += [f.position(f.nearest(t)) for f in shown for t in times]
        points = [p for p in points if len(p)]
        low, high = np.min([p.min(0) for p in points], axis=0), np.max([p.max(0) for p in points], axis=0)
        pick = [self.across, self.up]
        margin = 0.03 * np.max((high - low)[pick])
        return low[pick] - margin, high[pick] + margin


def discs(axes, places, diameters, **style):
    """Circles true to size; returns them for a colour bar."""
    circles = EllipseCollection(diameters, diameters, np.zeros(len(places)), units="xy",
                                offsets=places, transOffset=axes.transData, **style)
    return axes.add_collection(circles)


def draw_walls(axes, run, time, scale, plane):
    for mesh in run.meshes(time):
        lines = outlines.edges(mesh, run.depth) if plane is None else outlines.cut(mesh, run.depth, plane)
        axes.add_collection(LineCollection(lines[:, :, [run.across, run.up]] * scale, colors="black",
                                           linewidths=0.6 if plane is None else 1.0))
    for body, low, high in run.boxes(time):
        a, b = run.across, run.up
        if body["shape"] == "box":
            corner, size = low[[a, b]] * scale, (high - low)[[a, b]] * scale
            axes.add_patch(Rectangle(corner, *size, facecolor=WALL, edgecolor="black", linewidth=0.5))
            continue
        closed = body.get("faces", FACES)
        for axis, other in ((a, b), (b, a)):
            for name, place in zip((FACES[2 * axis], FACES[2 * axis + 1]), (low[axis], high[axis])):
                if name not in closed or run.case["domain"].get("periodic", [False] * 3)[axis]:
                    continue
                ends = np.array([low[other], high[other]]) * scale
                line = ([place * scale] * 2, ends) if axis == a else (ends, [place * scale] * 2)
                axes.plot(*line, color="black", linewidth=1.2)


def plot_frames(options):
    run = Run(options.run_dir, options.view)
    first, last = run.times()[[0, -1]]
    times = [float(t) for t in options.times.split(",")] if options.times else [last]
    slack = 0.5 * (last - first) / max(len(run.times()) - 1, 1)
    for time in times:
        if not first - slack <= time <= last + slack:
            raise SystemExit(f"--times: {time:g} s is not in this run, which has frames from {first:.4g} to {last:.4g} s")
    low, high = run.window(times)
    scale, unit = (1e3, "mm") if np.max(high - low) < 1 else (1, "m")
    columns = len(times) if len(times) <= 2 else int(np.ceil(np.sqrt(len(times) * 0.7)))
    rows = int(np.ceil(len(times) / columns))
    width = 11 / columns
    height = width * (high - low)[1] / (high - low)[0]
    figure, panels = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True,
                                  figsize=(columns * width + 1.2, rows * (height + 0.45) + 0.5),
                                  layout="constrained")

    fluids = [run.fluid(t, options.field, options.slice) if "fluid" in run.frames else None for t in times]
    values = np.concatenate([f[2] for f in fluids if f is not None]) if fluids[0] is not None else np.zeros(1)
    limits = (0 if options.field == "speed" else np.percentile(values, 0.5), np.percentile(values, 99.5))
    if options.range:
        limits = tuple(float(v) for v in options.range.split(","))
    colours = None
    for axes, time, fluid in zip(panels.flat, times, fluids):
        if fluid is not None:
            colours = discs(axes, fluid[0] * scale, fluid[1] * scale, array=fluid[2],
                            cmap=FIELDS[options.field][2], clim=limits, linewidths=0, rasterized=True)
        if "grains" in run.frames:
            places, diameters = run.grains(time, options.slice)
            discs(axes, places * scale, diameters * scale, facecolors=GRAIN_FILL, edgecolors=GRAIN_EDGE,
                  linewidths=0.25, rasterized=True)
        draw_walls(axes, run, time, scale, options.slice)
        shown = run.times()[np.argmin(np.abs(run.times() - time))]
        axes.set_title(f"t = {shown:.3g} s", fontsize=10)
        axes.set_xlim(low[0] * scale, high[0] * scale)
        axes.set_ylim(low[1] * scale, high[1] * scale)
        axes.set_aspect("equal")
    for axes in list(panels.flat)[len(times):]:
        axes.set_axis_off()
    for axes in panels[-1]:
        axes.set_xlabel(f"{options.view[0]} ({unit})")
    for axes in panels[:, 0]:
        axes.set_ylabel(f"{options.view[1]} ({unit})")
    if colours is not None:
        figure.colorbar(colours, ax=panels, label=FIELDS[options.field][1], shrink=0.8)
    if run.case.get("title"):
        figure.suptitle(run.case["title"], fontsize=11)
    save(figure, options.out)


def unit_of(name):
    """Unit of a column named "speed [m/s]"."""
    return name[name.rindex("[") + 1 : -1] if name.endswith("]") else ""


def axis_label(names):
    """Of columns of one unit: their names without components, or the words that many of them have in common."""
    unit = unit_of(names[0])
    plain = list(dict.fromkeys(re.sub(r"(_[xyz])?( \[.*\])?$", "", name) for name in names))
    if len(plain) > 3:
        words = [name.split("_") for name in plain]
        plain = [" ".join(word for word in words[0] if all(word in others for others in words)) or "values"]
    return ", ".join(plain).replace("_", " ") + (f" ({unit})" if unit else "")


def draw_curve(axes, options, time, value, label):
    """A column over time, its running mean over it, or its spectrum."""
    if options.spectrum:
        try:
            axes.loglog(*spectrum(time, value), label=label, linewidth=1.2)
        except ValueError as error:
            raise SystemExit(f"--spectrum: {label}: {error}") from None
        return
    line, = axes.plot(time, value, label=label, linewidth=1.5)
    if options.mean:
        line.set(linewidth=0.6, alpha=0.5, label="_" + label)
        axes.plot(time, running_mean(time, value, options.mean), color=line.get_color(), label=label, linewidth=1.8)


def plot_probe(options):
    tables = {Path(path).stem: Table(path) for path in options.csv}
    curves = [(stem, table, name) for stem, table in tables.items() for name in options.column or table.header[1:]]
    units = list(dict.fromkeys(unit_of(name) for _, _, name in curves))  # what has another unit has its own panel
    columns = int(np.ceil(np.sqrt(len(units) / 2)))
    rows = int(np.ceil(len(units) / columns))
    figure, panels = plt.subplots(rows, columns, squeeze=False, figsize=(7 * columns, 4.5 if rows == 1 else 3.2 * rows),
                                  layout="constrained")
    for axes, unit in zip(panels.flat, units):
        mine = [curve for curve in curves if unit_of(curve[2]) == unit]
        names = sorted({name for _, _, name in mine})
        for stem, table, name in mine:
            label = stem if len(names) == 1 else name if len(tables) == 1 else f"{stem}: {name}"
            draw_curve(axes, options, table.column(table.header[0]), table.column(name), label)
        of = axis_label(list(dict.fromkeys(name for _, _, name in mine)))
        axes.set_ylabel(f"spectral density of {of.rpartition(' (')[0] or of} (({unit})$^2$/Hz)" if options.spectrum else of)
    for axes in list(panels.flat)[len(units):]:
        axes.set_axis_off()
    axes = panels[0, 0]
    markers = iter("osD^v<>PX*")
    for path in options.reference:
        table = Table(path)
        if options.where:
            table = table.where(dict(pair.split("=", 1) for pair in options.where))
        numeric = table.numeric()
        x, y = options.reference_columns.split(",") if options.reference_columns else numeric[:2]
        names = table.texts("series") if "series" in table.names() else [Path(path).stem] * len(table.texts(x))
        for series in dict.fromkeys(names):
            picked = np.array([name == series for name in names])
            axes.plot(table.column(x)[picked], table.column(y)[picked], next(markers, "."), label=series,
                      markersize=5, markerfacecolor="none")
    for axes in panels.flat[: len(units)]:
        axes.set_xlabel("frequency (Hz)" if options.spectrum else axis_label([next(iter(tables.values())).header[0]]))
        axes.grid(alpha=0.3)
        many = len(axes.lines) > 6
        axes.legend(frameon=False, fontsize=7 if many else 9, **({"bbox_to_anchor": (1, 1)} if many else {}))
    save(figure, options.out)


def scaling_series(report):
    """Rows of a report of `bedload bench`, by benchmark, precision and kind of scaling, ordered by ranks."""
    series = {}
    for row in report["rows"]:
        if "scaling" in row:
            series.setdefault((row["row"], row["precision"], row["scaling"]), []).append(row)
    return {key: sorted(rows, key=lambda row: row["ranks"]) for key, rows in series.items()}


def plot_scaling(options):
    report = json.loads(Path(options.json).read_text(encoding="utf-8"))
    series = scaling_series(report)
    if not series:
        raise SystemExit(f"{options.json}: has no rows of scaling; bedload bench --ranks 1,2,4 --json makes them")
    figure, panels = plt.subplots(1, 3, figsize=(13, 4), layout="constrained")
    most = max(row["ranks"] for rows in series.values() for row in rows)
    for (name, precision, kind), rows in series.items():
        ranks = [row["ranks"] for row in rows]
        style = {"marker": "o" if kind == "strong" else "s", "linestyle": "-" if kind == "strong" else "--",
                 "label": f"{name}, {precision}, {kind}"}
        for axes, key in zip(panels, ("speed_up", "efficiency_percent", "wait_percent")):
            axes.plot(ranks, [row[key] for row in rows], **style)
        panels[0].plot([ranks[0], most], [1, most / ranks[0]], color="0.7", linewidth=0.8, zorder=0)
    for axes, label in zip(panels, ("speed-up (-)", "efficiency (%)", "waits for other ranks (% of time)")):
        axes.set(xlabel="ranks (-)", ylabel=label, ylim=(0, None))
        axes.set_xticks(sorted({row["ranks"] for rows in series.values() for row in rows}))
        axes.grid(alpha=0.3)
    panels[0].legend(frameon=False, fontsize=8)
    figure.suptitle(f"{report['device']}, commit {report['commit']}", fontsize=10)
    save(figure, options.out)


DRAG_POINTS = ["solid_fraction", "reynolds", "measured", "least", "most"]


def plot_drag_laws(options):
    tables = [Table(path) for path in options.csv]
    for table in tables:
        if table.names()[:5] != DRAG_POINTS:
            raise SystemExit(f"{table.path}: must begin with the columns {', '.join(DRAG_POINTS)}, as bedload drag "
                             "writes them")
    fractions = sorted({value for table in tables for value in table.column("solid_fraction")})
    columns = min(len(fractions), 2)
    rows = int(np.ceil(len(fractions) / columns))
    figure, panels = plt.subplots(rows, columns, squeeze=False, layout="constrained",
                                  figsize=(4 * columns + 1.5, 3.2 * rows))
    for axes, fraction in zip(panels.flat, fractions):
        for table in tables:
            here = table.column("solid_fraction") == fraction
            reynolds, found, least, most = (table.column(name)[here] for name in DRAG_POINTS[1:])
            known = np.isfinite(found)
            order = np.argsort(reynolds, kind="stable")
            for k, law in enumerate(table.names()[5:]):
                style = {"color": f"C{k}", "linestyle": "--" if k < 2 else "-", "linewidth": 1.2}
                label = "_" if table is not tables[0] else law.replace("_", " ")
                axes.loglog(reynolds[order], table.column(law)[here][order], label=label, **style)
            spread = [found[known] - least[known], most[known] - found[known]]
            axes.errorbar(reynolds[known], found[known], spread, fmt="ko", markersize=5, capsize=3, zorder=9,
                          label="resolved" if table is tables[0] else "_")
        axes.set(title=f"solid fraction {fraction:g}", xlabel="Reynolds number (-)", ylabel=r"$K / (3 \pi \mu d)$ (-)")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("{x:g}")
        axes.tick_params(which="both", labelsize=8)
        axes.grid(alpha=0.3, which="both")
    for axes in list(panels.flat)[len(fractions):]:
        axes.set_axis_off()
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside right upper", frameon=False, fontsize=8)
    save(figure, options.out)


def save(figure, path):
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=160)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(required=True)
    frames = kinds.add_parser("frames", help="side view of fluid, grains and walls")
    frames.add_argument("run_dir")
    frames.add_argument("--times", help="comma-separated, s; default: the last frame")
    frames.add_argument("--out", required=True, help="PNG or PDF")
    frames.add_argument("--field", choices=FIELDS, default="speed")
    frames.add_argument("--range", help="low,high of the colour bar, in the field's unit")
    frames.add_argument("--slice", type=float, help="show only what this plane cuts, coordinate in m")
    frames.add_argument("--view", choices=["xz", "xy", "yz"], default="xz")
    frames.set_defaults(run=plot_frames)
    probe = kinds.add_parser("probe", help="columns of tables over time")
    probe.add_argument("csv", nargs="+")
    probe.add_argument("--out", required=True, help="PNG or PDF")
    probe.add_argument("--column", action="append", help="default: all")
    probe.add_argument("--mean", type=float, metavar="SECONDS", help="also draw running means over this time")
    probe.add_argument("--spectrum", action="store_true", help="draw spectral densities over frequency")
    probe.add_argument("--reference", nargs="*", default=[], help="CSV files shown as markers")
    probe.add_argument("--reference-columns", help="x,y; default: the first two that are numbers")
    probe.add_argument("--where", nargs="*", help="column=value: rows of the references to show")
    probe.set_defaults(run=plot_probe)
    scaling = kinds.add_parser("scaling", help="speed-up over the number of ranks")
    scaling.add_argument("json", help="of bedload bench")
    scaling.add_argument("--out", required=True, help="PNG or PDF")
    scaling.set_defaults(run=plot_scaling)
    laws = kinds.add_parser("drag-laws", help="measured drag beside the drag laws")
    laws.add_argument("csv", nargs="+", help="of bedload drag")
    laws.add_argument("--out", required=True, help="PNG or PDF")
    laws.set_defaults(run=plot_drag_laws)
    options = parser.parse_args()
    if getattr(options, "mean", None) is not None and not options.mean > 0:
        parser.error(f"--mean {options.mean:g} must be above 0 s")
    options.run(options)


if __name__ == "__main__":
    main()
