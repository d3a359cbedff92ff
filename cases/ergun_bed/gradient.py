#!/usr/bin/env python3
"""Compares drag and pressure inside the bed with Ergun's equation.

    gradient.py RUN_DIR

Averages over the second half of the run, over all that is at least 5 diameters inside the bed. Exits with 1 if
drag or gradient differ from the law by more than 3 %.
"""

import sys
import tomllib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames  # noqa: E402

TOLERANCE = 0.03


def ergun(porosity, speed, d, rho, mu):
    """Pressure gradient less rho g at a superficial speed, Pa/m."""
    solid = 1 - porosity
    return (150 * mu * solid / d + 1.75 * rho * speed) * solid * speed / (porosity**3 * d)


def main(arguments):
    if len(arguments) != 1:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    run = Path(arguments[0])
    with open(run / "case.resolved.toml", "rb") as file:
        case = tomllib.load(file)
    rho, mu, d = case["fluid"]["rho0"], case["fluid"]["mu"], case["grain"]["d"]
    weight = rho * abs(case["gravity"][2])
    speed = case["wall"]["body"][0]["motion"]["velocity"][2]
    fluid, grains = Frames(run / "fluid.vtkhdf"), Frames(run / "grains.vtkhdf")
    z = grains.position(0)[:, 2]
    spacing = np.diff(np.unique(np.round(z, 7))).mean()
    porosity = 1 - np.pi / 6 * (d / spacing) ** 3
    low, high = z.min() - spacing / 2 + 5 * d, z.max() + spacing / 2 - 5 * d
    gradient, drag, flux, lift = [], [], [], []
    for k in range(len(fluid.times)):
        if fluid.times[k] < fluid.times[-1] / 2:
            continue
        place = fluid.position(k)[:, 2]
        inside = (place > low) & (place < high)
        gradient.append(-np.polyfit(place[inside], fluid.get(k, "pressure")[inside], 1)[0])
        flux.append(porosity * fluid.get(k, "velocity")[inside, 2].mean())
        inner = (z > low) & (z < high)
        drag.append(grains.get(k, "drag_force")[inner, 2].mean())
        lift.append(grains.get(k, "fluid_force")[inner, 2].mean())
    law = ergun(porosity, speed, d, rho, mu)
    volume = porosity * spacing**3                       # what of the law's gradient is drag, for each grain
    rows = [("drag", np.mean(drag) / (law * volume)), ("gradient less rho g", (np.mean(gradient) - weight) / law)]
    print(f"porosity {porosity:.4f}, {speed * 1e3:g} mm/s, law {law:.5g} Pa/m, {len(drag)} frames")
    failed = 0
    for name, found in rows:
        passed = abs(found - 1) <= TOLERANCE
        failed += not passed
        print(f"{'pass' if passed else 'FAIL'}  {name}: {found:.4f} of the law (within {100 * TOLERANCE:g} %)")
    print(f"      whole gradient: {np.mean(gradient) / (law + weight):.4f}, standard error "
          f"{np.std(gradient) / law / len(gradient) ** 0.5:.3f} of the law")
    print(f"      water through the bed: {np.mean(flux) / speed:.4f} of the piston's speed")
    push = np.mean(lift) / ((1 - porosity) * spacing**3)  # gradient that the pressure force on a grain stands for
    print(f"      gradient less rho g by the pressure force on the grains: {(push - weight) / law:.4f} of the law")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
