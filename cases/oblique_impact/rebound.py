#!/usr/bin/env python3
"""How the spheres rebound.

    rebound.py RUN_DIR

Prints, and writes to RUN_DIR/rebound.csv, for angles of incidence from the normal (degrees): tangential restitution
(speed of the centre along the plate after over before), spin (rad/s), the direction in which the point of contact
rebounds (degrees from the normal, negative: backwards) and the restitution along the normal. compare.py tells how
far that is from the references: expect.toml for the oxide, expect_alloy.toml for the alloy.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, write_table  # noqa: E402


def impacts(run):
    """Columns by name, a row for each sphere, lowest angle first."""
    grains = Frames(run / "grains.vtkhdf")

    def by_id(frame, field):
        return grains.get(frame, field)[np.argsort(grains.get(frame, "id"))]

    last = len(grains.times) - 1
    before, after = by_id(0, "velocity"), by_id(last, "velocity")
    spin = by_id(last, "angular_velocity")[:, 1]
    if np.any(after[:, 2] <= 0):
        raise SystemExit(f"{run}: a sphere has not rebounded by {grains.times[last]:g} s")
    slip = after[:, 0] - spin * by_id(last, "radius")
    found = {
        "incidence [deg]": np.degrees(np.arctan2(before[:, 0], -before[:, 2])),
        "restitution [-]": after[:, 0] / before[:, 0],
        "spin [rad/s]": spin,
        "rebound [deg]": np.degrees(np.arctan2(slip, after[:, 2])),
        "normal [-]": -after[:, 2] / before[:, 2],
    }
    order = np.argsort(found["incidence [deg]"])
    return {name: values[order] for name, values in found.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    run = Path(parser.parse_args().run)
    found = impacts(run)
    write_table(run / "rebound.csv", list(found), np.transpose(list(found.values())).tolist())
    print("incidence (deg)  restitution  spin (rad/s)  rebound (deg)  along the normal")
    for angle, tangential, spin, rebound, normal in zip(*found.values()):
        print(f"{angle:15.1f}  {tangential:11.4f}  {spin:12.1f}  {rebound:13.2f}  {normal:16.4f}")


if __name__ == "__main__":
    main()
