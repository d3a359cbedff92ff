#!/usr/bin/env python3
"""What an engineer asks of a run of the case: how deep the jet has dug, with time, how wide the hole is, what is left
when the jet stops. Usage: scour.py RESULTS

Writes RESULTS/scour.csv, depth over time.

The bed is divided into rings about the jet. Its surface in a ring is where the solid fraction falls below one half of
that of the bed at rest, from the floor upwards, so that grains in suspension do not count."""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of, write_table  # noqa: E402

G = 9.81


def surface(x, d, inner, outer, half_of):
    """Height of the bed between two radii, m: layers one diameter thick, a quarter of one apart."""
    r = np.hypot(x[:, 0], x[:, 1])
    z = np.sort(x[(r >= inner) & (r < outer), 2])
    per_grain = np.pi / 6 * d**3 / (np.pi * (outer**2 - inner**2) * d)
    middles = np.arange(0.5, 60, 0.25) * d
    counts = np.searchsorted(z, middles + d / 2) - np.searchsorted(z, middles - d / 2)
    loose = np.flatnonzero(counts * per_grain < half_of)
    return float(middles[loose[0]] if len(loose) and loose[0] > 0 else 0.0)


def main(folder):
    case = case_of(folder)
    fluid, grain, inlet = case["fluid"], case["grain"], case["inlet"][0]
    frames = Frames(Path(folder) / "grains.vtkhdf")
    d, radius, speed = grain["d"], inlet["radius"], inlet["velocity"]
    start = frames.position(0)
    wide = float(min(case["wall"]["body"][0]["max"][:2]))
    rings = np.arange(0, wide + 1e-9, max(radius, 2 * d))
    at_rest = np.sum(start[:, 2] < np.median(start[:, 2])) * np.pi / 6 * d**3 / (
        np.median(start[:, 2]) * (2 * wide)**2)  # solid fraction of the lower half

    def profile(frame):
        x = frames.position(frame)
        return np.array([surface(x, d, a, b, at_rest / 2) for a, b in zip(rings, rings[1:])])

    level = float(np.mean(profile(0)))
    height = inlet["centre"][2] - level  # of the nozzle above the bed
    erosion = speed * 2 * radius / height / np.sqrt(G * d * (grain["rho"] / fluid["rho0"] - 1))
    print(f"bed {1000 * level:.0f} mm deep, solid fraction {at_rest:.2f}; nozzle {1000 * height:.0f} mm above it "
          f"({height / 2 / radius:.1f} of its diameters); E_c = {erosion:.2f}")
    rows = []
    for frame in range(len(frames.times)):
        shape = profile(frame) - level
        out = np.flatnonzero(shape >= 0)
        rows.append((frames.times[frame], max(0.0, -shape.min()), rings[out[0]] if len(out) else wide,
                     max(0.0, shape.max())))
    write_table(Path(folder) / "scour.csv", ["time [s]", "depth [m]", "radius [m]", "ridge [m]"], rows)
    print("time (s)   depth (mm)   radius at the old level (mm)   ridge (mm)")
    for time, depth, out, ridge in rows[::max(1, len(rows) // 12)]:
        print(f"{time:8.2f}   {1000 * depth:10.1f}   {1000 * out:28.0f}   {1000 * ridge:10.1f}")

    axis = Table(Path(folder) / "probes" / "axis.csv")
    stop, probe = inlet.get("stop", np.inf), case["probe"][0]["at"][2]
    steady = (axis["time"] > stop / 4) & (axis["time"] < stop)
    away = inlet["centre"][2] - probe
    jet = 6.3 * speed * 2 * radius / away if away > 12.6 * radius else speed
    static = max(0.0, 1.26 * erosion**0.11 - 1) * height
    last = f"{1000 * rows[-1][1]:.1f} mm" if rows[-1][0] > stop else "the jet still runs"
    for what, value in [(f"speed on the axis {1000 * away:.0f} mm below the nozzle",
                         f"{-np.nanmean(axis['velocity_z'][steady]):.2f} m/s" if steady.any() else "-"),
                        ("of a free turbulent jet there, 6.3 U d / x", f"{jet:.2f} m/s"),
                        ("deepest while the jet runs", f"{1000 * max(r[1] for r in rows if r[0] <= stop):.1f} mm"),
                        ("depth at the end, jet off", last),
                        ("static depth after long times, by E_c", f"{1000 * static:.1f} mm")]:
        print(f"{what:55} {value}")


if __name__ == "__main__":
    main(sys.argv[1])
