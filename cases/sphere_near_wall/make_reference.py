"""Writes reference.csv: a sphere that sinks towards a plane in Stokes flow, with Brenner's resistance and its inertia.

H. Brenner, Chem. Eng. Sci. 16 (1961) 242: F = 6 pi mu R v lambda(h / R), h the height of the centre.

Usage: python3 make_reference.py
"""

from math import acosh, pi, sinh
from pathlib import Path

R, RHO, RHO_FLUID, MU, G, START = 5e-4, 5404.0, 1000.0, 0.1, 9.81, 1.05e-3


def resistance(h):
    a = acosh(h / R)
    total, n = 0.0, 1
    while True:
        numerator = 2 * sinh((2 * n + 1) * a) + (2 * n + 1) * sinh(2 * a)
        denominator = 4 * sinh((n + 0.5) * a) ** 2 - (2 * n + 1) ** 2 * sinh(a) ** 2
        term = n * (n + 1) / ((2 * n - 1) * (2 * n + 3)) * (numerator / denominator - 1)
        total += term
        n += 1
        if term < 1e-10 * total or n * a > 300:
            return 4 / 3 * sinh(a) * total


volume = 4 / 3 * pi * R**3
weight, mass, friction = (RHO - RHO_FLUID) * volume * G, RHO * volume, 6 * pi * MU * R
lines = ["# Sphere near a plane, by make_reference.py: time, height, velocity, resistance over Stokes drag",
         "t_s,z_m,velocity_m_s,lambda"]
t, z, v, dt = 0.0, START, 0.0, 2e-5
for k in range(100000):
    factor = resistance(z)
    if k % 100 == 0:
        lines.append(f"{t:.4f},{z:.6e},{v:.6e},{factor:.5f}")
    if z < 1.03 * R:
        break
    rate = friction * factor / mass  # implicit in the drag
    v = (v - dt * weight / mass) / (1 + dt * rate)
    z += dt * v
    t += dt
Path(__file__).with_name("reference.csv").write_text("\n".join(lines) + "\n")
