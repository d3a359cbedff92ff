#!/usr/bin/env python3
"""The agitator on its own: a cylinder whose cap rolls and slides in the shaken tube, by its equation of motion.

    rolling.py [--friction 0.3] [--rolling 0] [--periods 12]

Coulomb friction at the contact, and a couple rolling x normal force x radius against the spin. Numbers are those of
table 1 of He et al. (2018). Prints the top speed of each period and the phases of A (highest), C (lowest) and E
(highest) in the last, to check the solver, and what the paper reports, against.
"""

import argparse
import math

G = 9.81  # m/s2
FREQUENCY, AMPLITUDE = 4.06, 7.1e-3  # Hz, m, of the tube
CAP, BORE = 8.7e-3, 12.7e-3  # radii, m
INERTIA, MASS = 2.516e-7, 5.06e-3  # kg m2, kg
STEP = 2e-5  # s


def motion(friction, rolling, periods):
    """(t, angle of the centre about the axis of the tube from below, its speed) at each step; s, rad, m/s."""
    omega = 2 * math.pi * FREQUENCY
    arm, ratio = BORE - CAP, INERTIA / (MASS * CAP**2)
    t = angle = v = rim = 0.0  # rim: speed of the cap's surface by its spin, m/s
    while t < periods / FREQUENCY:
        sideways = AMPLITUDE * omega**2 * math.sin(omega * t)
        along = sideways * math.cos(angle) - G * math.sin(angle)
        press = max(0.0, G * math.cos(angle) + sideways * math.sin(angle) + v**2 / arm)
        couple = rolling * press / ratio * STEP
        rim -= max(-couple, min(couple, rim))
        hold = -((v + rim) / STEP + along) / (1 + 1 / ratio)  # that would end the slip in this step
        grip = max(-friction * press, min(friction * press, hold))
        v += (along + grip) * STEP
        rim += grip / ratio * STEP
        angle += v / arm * STEP
        t += STEP
        yield t, angle, v


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--friction", type=float, default=0.3)
    parser.add_argument("--rolling", type=float, default=0.0)
    parser.add_argument("--periods", type=int, default=12)
    args = parser.parse_args()

    path = list(motion(args.friction, args.rolling, args.periods))
    for n in range(args.periods):
        part = [(2 * (t * FREQUENCY - n), angle, abs(v)) for t, angle, v in path if n <= t * FREQUENCY < n + 1]
        print(f"period {n + 1}: top speed {max(v for _, _, v in part):.4f} m/s")
    a = max(part, key=lambda row: row[1])[0]
    e = min(part, key=lambda row: row[1])[0]
    c = min((row for row in part if a < row[0] < e), key=lambda row: abs(row[1]))[0]
    print(f"A {a:.3f} pi, C {c:.3f} pi, E {e:.3f} pi; 0.581, 1.150 and 1.637 pi in the paper")


if __name__ == "__main__":
    main()
