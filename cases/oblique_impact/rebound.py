#!/usr/bin/env python3
"""How the spheres rebound, against experiment, other DEM and sliding by rigid-body mechanics.

    rebound.py RUN_DIR

Prints, for angles of incidence from the normal (degrees), tangential restitution (speed of the centre along the plate
after over before), spin (rad/s) and the direction in which the point of contact rebounds (degrees from the normal,
negative: backwards); then how far they are from each reference, FAIL with every point beyond its tolerance. Which
reference, oxide or alloy, follows from grain.rho. Exit code 1 if something is beyond.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table, case_of  # noqa: E402

HERE = Path(__file__).parent
TOLERANCE = {"restitution": 0.03, "spin_rad_s": 25.0, "rebound_deg": 2.5}
OTHER_LAW = 0.05  # of the restitution up to 30 degrees, if friction is not Mindlin's spring
SLIDING = 0.01  # relative
NORMAL = 0.005  # of the restitution along the normal
OXIDE, ALLOY = 4000.0, 2700.0  # kg/m3


def impacts(run):
    """Quantities by name, of each sphere, lowest angle first; "incidence_deg" and "normal" (restitution) too."""
    grains = Frames(run / "grains.vtkhdf")

    def by_id(frame, field):
        return grains.get(frame, field)[np.argsort(grains.get(frame, "id"))]

    last = len(grains.times) - 1
    before, after = by_id(0, "velocity"), by_id(last, "velocity")
    spin = by_id(last, "angular_velocity")[:, 1]
    if np.any(after[:, 2] <= 0):
        raise SystemExit(f"{run}: a sphere has not rebounded by {grains.times[last]:g} s")
    incidence = np.degrees(np.arctan2(before[:, 0], -before[:, 2]))
    slip = after[:, 0] - spin * by_id(last, "radius")
    found = {
        "incidence_deg": incidence,
        "restitution": after[:, 0] / before[:, 0],
        "spin_rad_s": spin,
        "rebound_deg": np.degrees(np.arctan2(slip, after[:, 2])),
        "normal": -after[:, 2] / before[:, 2],
    }
    order = np.argsort(incidence)
    return {name: values[order] for name, values in found.items()}


def report(title, quantity, angles, found, expected, bounds, other=None):
    """Prints one comparison; true if no point is beyond its bound. `other`: values of other DEM, told too."""
    error = found - expected
    worst = np.argmax(np.abs(error) / bounds)
    good = bool(np.all(np.abs(error) <= bounds))
    print(f"{'pass' if good else 'FAIL'}  {title}, {quantity}: {error[worst]:+.3g} (<= {bounds[worst]:.3g}) at "
          f"{angles[worst]:.3g} degrees, {len(angles)} points")
    for k in np.flatnonzero(np.abs(error) > bounds):
        told = "" if other is None or np.isnan(other[k]) else f"; Chung & Ooi {other[k]:.4g}"
        print(f"        {angles[k]:5.1f} degrees: {found[k]:.4g}, expected {expected[k]:.4g} within {bounds[k]:.3g}"
              f"{told}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    args = parser.parse_args()

    run = Path(args.run)
    case = case_of(run)
    rho = case["grain"]["rho"]
    if rho not in (OXIDE, ALLOY):
        raise SystemExit(f"{run}: grain.rho = {rho:g} kg/m3 is neither oxide ({OXIDE:g}) nor alloy ({ALLOY:g})")
    law = case["contact"]["tangential"]
    found = impacts(run)
    at = found["incidence_deg"]

    print(f"{'oxide' if rho == OXIDE else 'alloy'}, contact.tangential = {law}")
    print("incidence (deg)  restitution  spin (rad/s)  rebound (deg)  along the normal")
    for k in range(len(at)):
        print(f"{at[k]:15.1f}  {found['restitution'][k]:11.4f}  {found['spin_rad_s'][k]:12.1f}"
              f"  {found['rebound_deg'][k]:13.2f}  {found['normal'][k]:16.4f}")

    good = []
    e = case["grain"]["e"]
    good.append(report("grain.e", "normal", at, found["normal"], np.full(len(at), e), np.full(len(at), NORMAL)))
    series = ["experiment", "dem_oxide"] if rho == OXIDE else ["dem_alloy"]
    reference = Table(HERE / "reference.csv")
    for name in series:
        for quantity, tolerance in TOLERANCE.items():
            if name == "dem_alloy" and quantity == "rebound_deg":
                continue  # the source has the oxide's curve in its place
            points = reference.where({"series": name, "quantity": quantity})
            angles, expected = points.column("incidence_deg"), points.column("value")
            bounds = np.full(len(angles), tolerance)
            if quantity == "restitution" and law != "mindlin":
                bounds[angles <= 30] = OTHER_LAW
            values = np.interp(angles, at, found[quantity])
            other = None
            if name == "experiment":
                dem = reference.where({"series": "dem_oxide", "quantity": quantity})
                other = np.interp(angles, dem.column("incidence_deg"), dem.column("value"), left=np.nan, right=np.nan)
            good.append(report(name, quantity, angles, values, expected, bounds, other))
    sliding = Table(HERE / "sliding.csv")
    angles = sliding.column("incidence_deg")
    for quantity in TOLERANCE:
        expected, values = sliding.column(quantity), np.interp(angles, at, found[quantity])
        good.append(report("sliding", quantity, angles, values, expected, SLIDING * np.abs(expected)))
    print(f"{sum(good)} of {len(good)} as expected")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
