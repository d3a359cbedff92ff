#!/usr/bin/env python3
"""Fits the profile of a reverse Poiseuille flow and tells the viscosity.

    viscosity.py RUN_DIR [TOLERANCE]

The velocity of the particles, less the mean of all, is fitted by A z (D - z) in each half, one h beside each flip left
out; eta = rho0 f / 2 A. The first 2 D^2 / pi^2 nu are left out, the error is that of the mean of blocks, each longer than
D^2 / pi^2 nu. Writes the profile to RUN_DIR/profile.csv and exits with 1 if eta differs from the case's mu by more than
TOLERANCE (0.03), or the R^2 of the whole profile is below 0.95.
"""

import sys
import tomllib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames  # noqa: E402

BINS = 20  # a half


def main(arguments):
    if len(arguments) not in (1, 2):
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    run, tolerance = Path(arguments[0]), float(arguments[1]) if len(arguments) == 2 else 0.03
    with open(run / "case.resolved.toml", "rb") as file:
        case = tomllib.load(file)
    fluid, domain, drive = case["fluid"], case["domain"], case["drive"]
    axis, along = "xyz".index(drive["opposed"]), int(np.argmax(np.abs(drive["f"])))
    low, length = domain["min"][axis], domain["max"][axis] - domain["min"][axis]
    D, mu, rho = length / 2, fluid["mu"], fluid["rho0"]
    f = drive["f"][along] * (rho if drive["mode"] == "mass" else 1)
    h, relaxation = fluid["h_over_dx"] * fluid["dx"], D**2 / np.pi**2 / (mu / rho)

    frames = Frames(run / "fluid.vtkhdf")
    kept = [k for k, t in enumerate(frames.times) if t >= 2 * relaxation]
    blocks = min(20, int((frames.times[-1] - 2 * relaxation) / relaxation))
    if blocks < 3:
        print(f"the run ends at {frames.times[-1]:g}, before {5 * relaxation:.3g}", file=sys.stderr)
        return 1
    products, squares = np.zeros(blocks), np.zeros(blocks)
    sums, counts = np.zeros(BINS), np.zeros(BINS)
    for n, k in enumerate(kept):
        z = (frames.position(k)[:, axis] - low) % length
        v = frames.get(k, "velocity")[:, along]
        v = v - v.mean()
        upper = z >= D
        z, v = np.where(upper, z - D, z), np.where(upper, -v, v)
        bins = np.minimum((z / D * BINS).astype(int), BINS - 1)
        sums += np.bincount(bins, v, BINS)
        counts += np.bincount(bins, minlength=BINS)
        shape, used, block = z * (D - z), (z > h) & (z < D - h), n * blocks // len(kept)
        products[block] += (v * shape)[used].sum()
        squares[block] += (shape[used] ** 2).sum()
    A, each = products.sum() / squares.sum(), products / squares
    eta = f / (2 * A)
    error = eta * each.std(ddof=1) / np.sqrt(blocks) / A
    filled = counts > 0  # on a lattice particles are in some bins alone
    centre = ((np.arange(BINS) + 0.5) * D / BINS)[filled]
    shape, profile = centre * (D - centre), sums[filled] / counts[filled]
    explained = 1 - ((profile - A * shape) ** 2).sum() / ((profile - profile.mean()) ** 2).sum()
    fastest = profile.max()
    with open(run / "profile.csv", "w", encoding="utf-8") as table:
        table.write("z,v,exact\n")
        for z, v, s in zip(centre, profile, shape):
            table.write(f"{z:.6g},{v:.6g},{f / (2 * mu) * s:.6g}\n")
    print(f"{len(kept)} frames in {blocks} blocks; peak {fastest:.4f}, exact {f * D * D / 8 / mu:.4f}; R^2 {explained:.4f}")
    print(f"Reynolds number {rho * fastest * D / mu:.3g}")
    passed = abs(eta / mu - 1) <= tolerance and explained >= 0.95
    print(f"{'pass' if passed else 'FAIL'}  eta {eta:.3f} +- {error:.3f}, {eta / mu:.4f} of mu (within {tolerance:g})")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
