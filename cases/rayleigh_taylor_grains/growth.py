#!/usr/bin/env python3
"""Fits how fast the wave of the interface grows and compares it with Chandrasekhar's dispersion relation.

    growth.py RUN_DIR

The wave's amplitude is told by the grains that are missing above its crests, -2 sum cos(k x) / (n A) over all grains;
n is their number density, A the section. Exits with 1 if the rate is off by more than 20 %.
"""

import sys
import tomllib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, Table  # noqa: E402

POROSITY, TOLERANCE, FIRST, LAST = 0.9, 0.2, 0.02, 0.2


def main(arguments):
    if len(arguments) != 1:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    run = Path(arguments[0])
    with open(run / "case.resolved.toml", "rb") as file:
        case = tomllib.load(file)
    table = Table(Path(__file__).parent / "growth.csv")
    row = (table.column("rho_lower") == case["fluid"]["rho0"]) & (table.column("porosity_upper_layer") == POROSITY)
    expected = table.column("n_viscous_chandrasekhar_1_s")[row][0]
    width, depth = case["domain"]["max"][:2]
    k = 2 * np.pi / width
    grains, fluid = Frames(run / "grains.vtkhdf"), Frames(run / "fluid.vtkhdf")
    density = (1 - POROSITY) / (np.pi / 6 * case["grain"]["d"] ** 3)
    t, wave, speed = np.array(grains.times), [], []
    for f in range(len(t)):
        wave.append(-2 * k * np.cos(k * grains.position(f)[:, 0]).sum() / (density * width * depth))
        w = fluid.get(f, "velocity")[:, 2]
        speed.append(2 * np.mean((w - w.mean()) * np.cos(k * fluid.position(f)[:, 0])))
    wave, speed = np.array(wave), np.array(speed)
    end = np.argmax(wave > LAST) if np.any(wave > LAST) else len(t)
    used = (np.arange(len(t)) < end) & (wave > FIRST)
    for time, a, w in list(zip(t, wave, speed))[:: max(1, len(t) // 10)]:
        print(f"{time:.4f} s  amplitude {a:.4f} / k, water {1e3 * w:.4f} mm/s")
    if used.sum() < 3:
        print(f"FAIL  growth: the wave comes to {wave.max():.3f} / k only")
        return 1
    found = np.polyfit(t[used], np.log(wave[used]), 1)[0]
    passed = abs(found / expected - 1) <= TOLERANCE
    word = "pass" if passed else "FAIL"
    print(f"{word}  growth {found:.2f} 1/s against {expected:.2f} ({100 * (found / expected - 1):+.1f} %, "
          f"within {100 * TOLERANCE:g}), {t[used][0]:.3f} to {t[used][-1]:.3f} s")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
