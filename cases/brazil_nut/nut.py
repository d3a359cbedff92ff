#!/usr/bin/env python3
"""Rise of the nut in the left cylinder, beside that of the bed on the axis of the right one, which has none.

    nut.py RUN_DIR

All places are means over two periods. The bed's speed at a height is the mean of the displacements, from one such mean
to the next, of the beads within two diameters of the axis, as far up and down as the nut reaches. Compared are the mean
speeds of the nut, and of a point that moves with the bed, from two bead diameters above where the nut lay to two below
where its top is at the surface; `ratio_above` is their ratio from one radius of the nut above where it lay. Writes
RUN_DIR/rise.csv with these, and RUN_DIR/nut.csv with height and place of the nut below the surface over time; prints
the first.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, case_of, write_table  # noqa: E402

AXIS = 0.022  # x of the right cylinder, m; the left one is at -AXIS
START = 0.5  # s, when the flow has formed
SPAN = 8  # frames, two periods: means over them are free of the leaps of the bed
RISE = ["time [s]", "nut_speed [m/s]", "bed_speed [m/s]", "ratio [-]", "ratio_above [-]"]
NUT = ["time [s]", "height [m]", "surface [m]", "below_surface [-]"]  # top of the nut, in bead diameters


def means(grains, span):
    """Times, and positions by id, as means over so many frames."""
    x, counts = [], range(span, len(grains.times) + 1, span)
    for end in counts:
        x.append(np.mean([grains.by_id(frame, "position") for frame in range(end - span, end)], axis=0, dtype=float))
    return np.array([np.mean(grains.times[end - span:end]) for end in counts]), np.array(x)


def bed_speed(x, times, reach, d):
    """Heights and the bed's mean speed there on the axis. x: [frames, beads, 3], of the right cylinder."""
    middle, move = 0.5 * (x[1:] + x[:-1]), x[1:] - x[:-1]
    late = times[:-1] >= START
    near = (np.hypot(middle[..., 0] - AXIS, middle[..., 1]) < 2 * d)[late]
    z, dz = middle[late][..., 2][near], move[late][..., 2][near]
    interval = np.diff(times)[late].mean()
    heights = np.arange(0, z.max(), 0.5 * d)
    speeds = [dz[np.abs(z - h) < reach].mean() / interval if np.any(np.abs(z - h) < reach) else np.nan for h in heights]
    return heights, np.array(speeds)


def passed(times, z, height):
    """When z first passes a height, NaN if never."""
    k = int(np.argmax(z > height))
    return times[k - 1] + (height - z[k - 1]) / (z[k] - z[k - 1]) * (times[k] - times[k - 1]) if k > 0 else np.nan


def main():
    run = Path(sys.argv[1])
    case, grains = case_of(run), Frames(run / "grains.vtkhdf")
    d, radius = case["grain"]["d"], grains.by_id(0, "radius")
    large, (times, x) = int(np.argmax(radius)), means(grains, SPAN)
    right, z = x[0, :, 0] > 0, x[:, large, 2]
    others = ~right & (np.arange(len(radius)) != large)
    surface = np.quantile(x[:, others, 2], 0.99, axis=1) + d / 2
    below = (surface - z - radius[large]) / d
    write_table(run / "nut.csv", NUT, np.stack([times, z, surface, below], axis=1).tolist())

    heights, speeds = bed_speed(x[:, right], times, radius[large], d)
    high = np.median(surface) - radius[large] - 2 * d

    def rise(low):
        """Mean speeds of nut and bed from a height to the highest one."""
        steps = np.linspace(low, high, 200)
        nut = (high - low) / (passed(times, z, high) - passed(times, z, low))
        return nut, 1 / np.mean(1 / np.interp(steps, heights, speeds))

    nut, bed = rise(z[0] + 2 * d)
    nut_above, bed_above = rise(z[0] + radius[large])
    row = [times[-1], nut, bed, nut / bed, nut_above / bed_above]
    write_table(run / "rise.csv", RISE, [row])
    for name, value in zip(RISE, row):
        print(f"{name:18} {value:.5g}")


if __name__ == "__main__":
    main()
