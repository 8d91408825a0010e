#!/usr/bin/python3
"""The actuator of Song (2002) by SciPy, written apart from plant_sim: the truth of its tests.

  reference.py                 writes reference.csv beside itself (what reference_test.cpp reads)
  reference.py calibrate       solves the valve gain that gives the printed b1 = 1.9672e-4
"""
import pathlib
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

THESIS = dict(Cd=0.60, rho=847.0, w=2.07e-2, zeta=0.70, wv=628.0, Kv=2.79e-5, L=0.61, beta=6.89e8,
              Ps=6.89e6, Pe=0.0, A=6.33e-4, d=1000.0, m=50.0, V0=1e-5)
# effects, as reference_test.cpp sets them
OIL = dict(asymmetry=0.08, droop=2e10, internal=3e-12, external=1e-12, air=0.01)
LOAD = dict(quadratic=2e4, spring=2e4, rest=0.3, force=300.0, ripple=100.0, wave=0.01, phase=1.0)
SCALE = np.array([1e-3, 1e-2, 1e6, 1e6, 1e-6, 1e-3])


def rate(_, x, u, p):
    y, v, pi, po, xv, sv = x
    k = p["Cd"] * p["w"] * xv * np.sqrt(2.0 / p["rho"])
    if xv >= 0:
        qi, qo = k * np.sqrt(p["Ps"] - pi), k * np.sqrt(po - p["Pe"])
    else:
        qi, qo = k * np.sqrt(pi - p["Pe"]), k * np.sqrt(p["Ps"] - po)
    wv = p["wv"]
    return [v, (p["A"] * (pi - po) - p["d"] * v) / p["m"],
            p["beta"] / (p["V0"] + p["A"] * y) * (qi - p["A"] * v),
            p["beta"] / (p["V0"] + p["A"] * (p["L"] - y)) * (p["A"] * v - qo),
            sv, -2 * p["zeta"] * wv * sv - wv * wv * xv + p["Kv"] * wv * wv * u]


def supply(k, port, p):
    """The supply pressure that the flow k sqrt(supply - port) leaves; found by bracketing."""
    droop = p.get("droop", 0.0)
    if droop == 0.0 or k == 0.0:
        return p["Ps"]
    return brentq(lambda at: p["Ps"] - droop * abs(k) * np.sqrt(at - port) - at, port, p["Ps"],
                  xtol=1e-6, rtol=1e-14)


def modulus(pressure, p):
    """Oil and bubbles squeezed together; pressure is gauge."""
    absolute = pressure + 1.01e5
    x = p.get("air", 0.0) * (1.01e5 / absolute) ** (1 / 1.4)
    return p["beta"] * (1 + x) / (1 + x * p["beta"] / (1.4 * absolute))


def resisting(y, v, p):
    ripple = p.get("ripple", 0.0) * np.sin(2 * np.pi * y / p.get("wave", 1.0) + p.get("phase", 0.0))
    return (p.get("quadratic", 0.0) * v * abs(v) + p.get("spring", 0.0) * (y - p.get("rest", 0.0))
            + p.get("force", 0.0) + ripple)


def rate_with_effects(_, x, u, p):
    y, v, pi, po, xv, sv = x
    k = p["Cd"] * p["w"] * xv * np.sqrt(2.0 / p["rho"])
    if "asymmetry" in p:
        k *= 1 + np.sign(xv) * p["asymmetry"]
    if xv >= 0:
        qi, qo = k * np.sqrt(supply(k, pi, p) - pi), k * np.sqrt(po - p["Pe"])
    else:
        qi, qo = k * np.sqrt(pi - p["Pe"]), k * np.sqrt(supply(k, po, p) - po)
    inside, outside = p.get("internal", 0.0) * (pi - po), p.get("external", 0.0)
    qi, qo = qi - inside - outside * pi, qo - inside + outside * po
    wv = p["wv"]
    return [v, (p["A"] * (pi - po) - p["d"] * v - resisting(y, v, p)) / p["m"],
            modulus(pi, p) / (p["V0"] + p["A"] * y) * (qi - p["A"] * v),
            modulus(po, p) / (p["V0"] + p["A"] * (p["L"] - y)) * (p["A"] * v - qo),
            sv, -2 * p["zeta"] * wv * sv - wv * wv * xv + p["Kv"] * wv * wv * u]


def held(x, u, span, p):
    """The state after `span` seconds of constant u."""
    equations = rate_with_effects if len(p) > len(THESIS) else rate
    out = solve_ivp(equations, (0.0, span), x, method="DOP853", rtol=1e-12, atol=1e-13 * SCALE,
                    args=(u, p))
    assert out.success
    return out.y[:, -1]


def start(p):
    return np.array([0.305, 0.0, p["Ps"] / 2, p["Ps"] / 2, 0.0, 0.0])


def loop(p, kp, periods):
    """Rows t, u, and the state at each sample of the 200 Hz loop; y is read before u is written."""
    x, rows = start(p), []
    for k in range(400 * periods):
        t = k * 0.005
        u = kp * (0.0254 * np.sin(np.pi * t) + 0.305 - x[0])
        rows.append([t, u, *x])
        x = held(x, u, 0.005, p)
    return np.array(rows)


def open_loop(p, volts):
    """A square wave: each voltage for 0.1 s, a row every 5 ms."""
    x, rows = start(p), []
    for k in range(20 * len(volts)):
        u = volts[k // 20]
        rows.append([k * 0.005, u, *x])
        x = held(x, u, 0.005, p)
    return np.array(rows)


def b1_per_period(rows):
    """Least squares of y(k) = -a1 y(k-1) + b1 u(k-1), each period of 400 samples alone."""
    u, y = rows[:, 1], rows[:, 2] - 0.305
    found = []
    for s in range(0, len(y) - 399, 400):
        psi = np.column_stack([-y[s:s + 399], u[s:s + 399]])
        found.append(np.linalg.lstsq(psi, y[s + 1:s + 400], rcond=None)[0][1])
    return np.array(found)


def calibrate():
    target, kv = 1.9672e-4, 2.23939e-5
    for _ in range(3):
        b1 = b1_per_period(loop(dict(THESIS, Kv=kv), 250.0, 3))
        print(f"Kv {kv:.8e}  b1 per period {b1}  off {b1[-1] / target - 1:+.2e}")
        kv *= target / b1[-1]


def main():
    lines = ["case,t_s,u_V,y_m,v_mps,pressure_in_Pa,pressure_out_Pa,spool_m,spool_mps"]
    cases = {"loop": loop(THESIS, 100.0, 2)[::20],
             "steps": open_loop(THESIS, [1.0, -1.0, 0.0, 2.0, -2.0])[::2],
             "oil": open_loop(dict(THESIS, **OIL), [1.0, -1.0, 0.5, 2.0, -2.0])[::2],
             "load": open_loop(dict(THESIS, **LOAD), [1.0, -1.0, 0.5, 2.0, -2.0])[::2],
             "stiff": open_loop(dict(THESIS, m=10.0, d=300.0, Ps=1.379e7), [0.5, -0.5, 3.0])[::2]}
    for name, rows in cases.items():
        for row in rows:
            lines.append(name + "," + ",".join(f"{value:.15g}" for value in row))
    pathlib.Path(__file__).with_name("reference.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    calibrate() if sys.argv[1:] == ["calibrate"] else main()
