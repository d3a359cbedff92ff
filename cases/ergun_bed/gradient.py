#!/usr/bin/env python3
"""Drag and pressure inside the bed over Ergun's equation.

    gradient.py RUN_DIR

Looks at all that is at least 5 diameters inside the bed. Writes RUN_DIR/bed.csv, a row for each frame, and prints
means over the second half of the run.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Frames, case_of, write_table  # noqa: E402


def ergun(porosity, speed, d, rho, mu):
    """Pressure gradient less rho g at a superficial speed, Pa/m."""
    solid = 1 - porosity
    return (150 * mu * solid / d + 1.75 * rho * speed) * solid * speed / (porosity**3 * d)


def main(arguments):
    if len(arguments) != 1:
        print(__doc__.strip().splitlines()[2].strip(), file=sys.stderr)
        return 2
    run = Path(arguments[0])
    case = case_of(run)
    rho, mu, d = case["fluid"]["rho0"], case["fluid"]["mu"], case["grain"]["d"]
    weight = rho * abs(case["gravity"][2])
    speed = case["wall"]["body"][0]["motion"]["velocity"][2]
    fluid, grains = Frames(run / "fluid.vtkhdf"), Frames(run / "grains.vtkhdf")
    z = grains.position(0)[:, 2]
    spacing = np.diff(np.unique(np.round(z, 7))).mean()
    porosity = 1 - np.pi / 6 * (d / spacing) ** 3
    low, high = z.min() - spacing / 2 + 5 * d, z.max() + spacing / 2 - 5 * d
    law = ergun(porosity, speed, d, rho, mu)
    volume = porosity * spacing**3  # what of the law's gradient is drag, for each grain
    solid = (1 - porosity) * spacing**3
    rows = []
    for k, time in enumerate(fluid.times):
        place = fluid.position(k)[:, 2]
        inside, inner = (place > low) & (place < high), (z > low) & (z < high)
        slope = -np.polyfit(place[inside], fluid.get(k, "pressure")[inside], 1)[0]
        drag, push = (grains.get(k, name)[inner, 2].mean() for name in ("drag_force", "fluid_force"))
        rows.append([time, drag / (law * volume), (slope - weight) / law, slope / (law + weight),
                     (push / solid - weight) / law, porosity * fluid.get(k, "velocity")[inside, 2].mean() / speed])
    names = ["drag", "gradient", "whole_gradient", "push_gradient", "flux"]
    write_table(run / "bed.csv", ["time [s]", *(f"{name} [-]" for name in names)], rows)
    late = np.array([row for row in rows if row[0] >= rows[-1][0] / 2])
    mean, error = late.mean(axis=0), late.std(axis=0) / len(late) ** 0.5
    print(f"porosity {porosity:.4f}, {speed * 1e3:g} mm/s, law {law:.5g} Pa/m, {len(late)} frames")
    for name, what in zip(names, ("drag over that of the law", "gradient less rho g over the law",
                                  "gradient over that of the law and rho g",
                                  "gradient less rho g by the pressure force on the grains, over the law",
                                  "water through the bed over the speed of the piston")):
        column = 1 + names.index(name)
        print(f"{what}: {mean[column]:.4f}, standard error {error[column]:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
