#!/usr/bin/env python3
"""Speed of Bedload, as a Markdown table.

Fluid rows (0.1M to 14M): the single-phase dam break, widened. The column is 146 mm long and 292 mm high in a
tank of 584 x 584 mm, spacing 4 mm, h = 1.3 dx, Wendland C2, Morris and artificial viscosity, continuity alone for the
density, no shifting; the width sets the size. Grain rows (8.8k, 1M spheres): equal frictional spheres in a box, settling.
Whole steps are timed, with every kernel, the list rebuilds and the adaptive step, but neither start nor files.
Particle-steps count fluid particles alone.
"""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

WIDTHS = {"0.1M": 0.152, "1M": 1.62, "5M": 8.1, "8M": 12.8, "14M": 22.6}  # m
BOXES = {"spheres-8.8k": (8800, 0.08), "spheres-1M": (1_000_000, 0.3)}  # number, side in m

DAM_BREAK = """
[domain]
min = [-0.04, -0.04, -0.04]
max = [0.624, {beyond}, 1.2]
[fluid]
dx = 0.004
h_over_dx = 1.3
[[fluid.fill]]
min = [0.0, 0.0, 0.0]
max = [0.146, {width}, 0.292]
[density]
delta = 0.0
consolidation = 0.0
[shift]
A = 0.0
[visc]
alpha = 0.02
[[wall.body]]
name = "tank"
shape = "tank"
min = [0.0, 0.0, 0.0]
max = [0.584, {width}, 0.584]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 10.0
[out]
every = 1.0
"""
DEFAULT_SETTINGS = ["fluid.h_over_dx=1.5", "density.delta=0.1", "density.consolidation=3", "shift.A=200"]

SPHERES = """
[domain]
min = [-0.01, -0.01, -0.01]
max = [{beyond}, {beyond}, {top}]
[grain]
d = 0.0027
[[grain.fill]]
min = [0.0, 0.0, 0.0]
max = [{side}, {side}, {height}]
count = {count}
[[wall.body]]
name = "box"
shape = "tank"
type = "grains_only"
min = [0.0, 0.0, 0.0]
max = [{side}, {side}, {height}]
faces = ["x-", "x+", "y-", "y+", "z-"]
[time]
end = 10.0
[out]
every = 1.0
"""


def case_text(row):
    if row in WIDTHS:
        return DAM_BREAK.format(width=WIDTHS[row], beyond=round(WIDTHS[row] + 0.04, 6))
    count, side = BOXES[row]
    height = round(count * 3.14159 / 6 * 0.0027**3 / 0.35 / side**2, 4)  # packed to 0.35
    return SPHERES.format(side=side, beyond=side + 0.01, count=count, height=height, top=height + 0.1)


def measure(program, case, precision, settings, options):
    """One row of the table, and the device."""
    command = [program.resolve(), case, "--precision", precision, "--backend", options.backend, "--at", options.at,
               "--steps", options.steps, "--spans", options.spans]
    if options.threads:
        command += ["--threads", options.threads]
    for setting in [*settings, *options.set]:
        command += ["--set", setting]
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:].strip() or f"{program.name} ended with {done.returncode}")
    result = json.loads(done.stdout.splitlines()[-1])
    spans, steps = result["spans"], result["steps"]
    seconds = [span["seconds"] for span in spans]
    median = statistics.median(seconds)
    substeps = statistics.median(span["substeps"] for span in spans)
    rebuilds = sum(span["rebuilds"] for span in spans)
    particles = result["fluid"] + result["walls"] + result["grains"]
    total_steps = steps * len(spans)
    return {
        "N fluid": f"{result['fluid']:,}",
        "N wall": f"{result['walls']:,}",
        "N grains": f"{result['grains']:,}",
        "precision": result["precision"],
        "h/dx": f"{result['h_over_dx']:g}" if result["fluid"] else "-",
        "steps per rebuild": f"{total_steps / rebuilds:.1f}" if rebuilds else f"> {total_steps}",
        "ms/step": f"{1e3 * median / steps:.3f}",
        "spread": f"{100 * (max(seconds) - min(seconds)) / median:.1f} %",
        "fluid particle-steps/s": f"{result['fluid'] * steps / median:.3g}" if result["fluid"] else "-",
        "us/substep": f"{1e6 * median / substeps:.2f}" if substeps else "-",
        "sphere-substeps/s": f"{result['grains'] * substeps / median:.3g}" if substeps else "-",
        "bytes/particle": f"{result['bytes'] / particles:.0f}",
    }, result["device"]


def table(rows):
    head = list(rows[0])
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row[key] for key in head) + " |" for row in rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path, help="the bedload_bench to run")
    parser.add_argument("--backend", default="cuda", choices=["cuda", "cpu"])
    parser.add_argument("--threads", type=int, help="CPU threads")
    parser.add_argument("--rows", default="1M,5M,8M,14M", help=f"of {', '.join([*WIDTHS, *BOXES])}")
    parser.add_argument("--case", type=Path, action="append", default=[], help="measure this case instead; repeatable")
    parser.add_argument("--precisions", default="single,mixed,double")
    parser.add_argument("--at", type=float, default=0.0, help="begin of measuring, s (dam break: 0.6 is splashed)")
    parser.add_argument("--steps", type=int, default=200, help="steps of one span")
    parser.add_argument("--spans", type=int, default=3, help="of which the median counts")
    parser.add_argument("--default-settings", action="store_true",
                        help="also the fluid rows with Bedload's own h, density diffusion, void relaxation and shifting")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key in all rows")
    options = parser.parse_args()

    rows, device, failed = [], "", False
    with tempfile.TemporaryDirectory() as scratch:
        jobs = [(case.parent.name if case.stem == "case" else case.stem, case, []) for case in options.case]
        for row in [] if jobs else options.rows.split(","):
            case = Path(scratch) / f"{row}.toml"
            case.write_text(case_text(row))
            jobs.append((row, case, []))
            if options.default_settings and row in WIDTHS:
                jobs.append((f"{row}, default settings", case, DEFAULT_SETTINGS))
        for label, case, settings in jobs:
            for precision in options.precisions.split(","):
                try:
                    row, device = measure(options.program, case, precision, settings, options)
                except RuntimeError as error:
                    print(f"{label} {precision}: {error}", file=sys.stderr)
                    failed = True
                    continue
                rows.append({"row": label, **row})
                print(f"{label} {precision}: {row['ms/step']} ms/step", file=sys.stderr, flush=True)
    if rows:
        print(f"Device: {device}. From t = {options.at:g} s, median of {options.spans} x {options.steps} steps.\n")
        print(table(rows))
    sys.exit(failed)


if __name__ == "__main__":
    main()
