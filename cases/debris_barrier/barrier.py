#!/usr/bin/env python3
"""What an engineer asks of a run of the case: the flow that arrives, force on the barrier, run-up, what is held back.
Usage: barrier.py RESULTS"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))
from frames import Table, case_of, running_mean  # noqa: E402

G = 9.81
FACE, SIDES = 1.36, 2.4  # x of the barrier's face, m; the banks rise by SIDES y^2, see make_valley.py


def arrival(table, section):
    """When a front passes a section, s."""
    beyond = table["front_x"] >= section
    if not beyond.any():
        sys.exit("the front does not reach the barrier")
    return float(table["time"][np.argmax(beyond)])


def main(folder):
    case = case_of(folder)
    probe = {path.stem: Table(path) for path in Path(folder).glob("probes/*.csv")}
    rho, rho_s = case["fluid"]["rho0"], case["grain"]["rho"]

    reaches = arrival(probe["front"], FACE - 0.02)
    speed_of_front = (FACE - 0.02 - 1.1) / (reaches - arrival(probe["front"], 1.1))
    time = probe["flow"]["time"]
    mass_flow = probe["flow"]["mass_flow"] + probe["flow_grains"]["mass_flow"]
    speed = np.interp(time, probe["speed"]["time"], np.nan_to_num(probe["speed"]["velocity_x"]))
    thrust = running_mean(time, mass_flow * speed, 0.05)  # momentum that arrives, kg m/s2
    peak = int(np.argmax(thrust))
    depth = float(np.interp(time[peak], probe["approach"]["time"], probe["approach"]["column_depth"]))

    force = running_mean(probe["barrier"]["time"], probe["barrier"]["force_total_x"], 0.02)
    by_grains = running_mean(probe["barrier"]["time"], probe["barrier"]["force_by_grains_x"], 0.02)
    most = int(np.argmax(force))
    late = probe["barrier"]["time"] > case["time"]["end"] - 0.2
    run_up = float(np.max(probe["run_up"]["column_depth"]))
    rest = float(np.mean(probe["run_up"]["column_depth"][-20:]))
    of_mud = probe["held_mud"]["mass"][-1] / probe["held_mud"]["mass"][0]
    of_grains = probe["held"]["mass"][-1] / probe["held"]["mass"][0]
    mass = probe["held_mud"]["mass"][-1], probe["held"]["mass"][-1]
    mixture = sum(mass) / (mass[0] / rho + mass[1] / rho_s)
    still = mixture * G * 8 / 15 * rest**2 * np.sqrt(rest / SIDES)  # on the parabola that the deposit wets

    rows = [("mud reaches the barrier", f"{reaches:.2f} s"),
            ("speed of its front over the last 0.24 m", f"{speed_of_front:.2f} m/s"),
            ("speed, depth of the flow 0.2 m before the barrier", f"{speed[peak]:.2f} m/s, {1000 * depth:.0f} mm"),
            ("Froude number", f"{speed[peak] / np.sqrt(G * max(depth, 1e-9)):.1f}"),
            ("flow there, mud and grains", f"{mass_flow[peak]:.2f} kg/s"),
            ("momentum it brings, at most", f"{thrust[peak]:.2f} N"),
            ("largest force on the barrier (mean over 20 ms), when", f"{force[most]:.2f} N, {time[most]:.2f} s"),
            ("of it by grains", f"{100 * by_grains[most] / force[most]:.0f} %"),
            ("largest force over the momentum", f"{force[most] / thrust[peak]:.2f}"),
            ("force in the last 0.2 s", f"{float(np.mean(force[late])):.2f} N"),
            ("thrust of a liquid as heavy and as deep, at rest", f"{still:.2f} N"),
            ("run-up on the barrier, at most", f"{1000 * run_up:.0f} mm"),
            ("v^2 / 2 g of the front", f"{1000 * speed_of_front**2 / (2 * G):.0f} mm"),
            ("held back: mud, grains", f"{100 * of_mud:.1f} %, {100 * of_grains:.1f} %")]
    for what, value in rows:
        print(f"{what:55} {value}")


if __name__ == "__main__":
    main(sys.argv[1])
