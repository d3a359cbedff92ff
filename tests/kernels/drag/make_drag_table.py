#!/usr/bin/env python3
"""Writes drag_table.csv: drag per slip velocity of every drag law, to 17 digits.

The laws are written here anew, from drag coefficients and pressure gradients and with
40-digit decimals, so that the table is a check on the solver's own formulas.
Usage: python3 make_drag_table.py
"""
from decimal import Decimal as D, getcontext
from math import atan
from pathlib import Path

getcontext().prec = 40
PI = D("3.14159265358979323846264338327950288420")


def power(base, exponent):
    return D(0) if base == 0 else (exponent * base.ln()).exp()


def coefficient_times_re(re):
    """C_D Re of a lone sphere: 24 at rest."""
    schiller = 24 + D("3.6") * power(re, D("0.687"))
    newton = D("0.44") * re
    return schiller if schiller > newton else newton


def force_per_slip(cd_re, eps, d, mu):
    """C_D (pi/8) rho d^2 u^2 / w with the superficial slip u = eps w, and Re = rho d u / mu."""
    return cd_re * PI * mu * d * eps / 8


def stokes(eps, d, rho, mu, w):
    return force_per_slip(D(24), D(1), d, mu)


def schiller_naumann(eps, d, rho, mu, w):
    return force_per_slip(coefficient_times_re(rho * d * eps * w / mu), D(1), d, mu)


def wen_yu(eps, d, rho, mu, w):
    # exchange coefficient 3/4 C_D rho eps (1 - eps) w / d eps^-2.65, times V / (1 - eps)
    re = rho * d * eps * w / mu
    return coefficient_times_re(re) * mu / d ** 2 * D("0.75") * (PI * d ** 3 / 6) * power(eps, D("-2.65"))


def ergun(eps, d, rho, mu, w):
    # pressure gradient of the superficial velocity u = eps w; force on one grain without the
    # part of the pressure force on its volume: eps V / (1 - eps) times the gradient
    solid = 1 - eps
    u = eps * w
    viscous = 150 * mu * solid ** 2 / (eps ** 3 * d ** 2)
    inertial = D("1.75") * rho * solid * u / (eps ** 3 * d)
    gradient = (viscous + inertial) * eps  # per interstitial slip
    volume = PI * d ** 3 / 6
    if solid == 0:
        return D("1.75") * rho * w / d * volume
    return gradient * eps * volume / solid


def gidaspow(eps, d, rho, mu, w):
    return ergun(eps, d, rho, mu, w) if eps <= D("0.8") else wen_yu(eps, d, rho, mu, w)


def gidaspow_blend(eps, d, rho, mu, w):
    dilute = D(atan(1.75 * 150 * float(eps - D("0.8")))) / PI + D("0.5")
    return dilute * wen_yu(eps, d, rho, mu, w) + (1 - dilute) * ergun(eps, d, rho, mu, w)


def di_felice(eps, d, rho, mu, w):
    re = rho * d * eps * w / mu
    if re == 0:
        cd_re, chi = D("4.8") ** 2, D("3.7")
    else:
        cd_re = (D("0.63") + D("4.8") / re.sqrt()) ** 2 * re
        chi = D("3.7") - D("0.65") * (-((D("1.5") - re.log10()) ** 2) / 2).exp()
    return force_per_slip(cd_re, D(1), d, mu) * power(eps, 1 - chi)


LAWS = (stokes, schiller_naumann, wen_yu, ergun, gidaspow, gidaspow_blend, di_felice)
FLUIDS = (("0.0001", "1000", "0.00089"), ("0.0027", "998", "0.001"))
REYNOLDS = ("0", "0.001", "0.1", "1", "10", "31.6", "100", "300", "1000", "3000", "10000")


def main():
    lines = [
        "# Drag on a sphere per interstitial slip velocity, written by make_drag_table.py, which shares no",
        "# code with the solver. d in m, rho in kg/m3, mu in Pa s, w in m/s, K in kg/s.",
        "law,eps,d,rho,mu,w,K",
    ]
    for law in LAWS:
        for eps in ("0.4", "0.8", "1"):
            for d, rho, mu in FLUIDS:
                for re in REYNOLDS:
                    w = float(D(re) * D(mu) / (D(rho) * D(d) * D(eps)))
                    k = law(D(eps), D(d), D(rho), D(mu), D(w))
                    lines.append(f"{law.__name__},{eps},{d},{rho},{mu},{w:.17g},{k:.17g}")
    Path(__file__).with_name("drag_table.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
