#!/usr/bin/python3
"""A single-rod cylinder by SciPy, written apart from plant_sim: the truth of cylinder_test.cpp.

  cylinder_reference.py        writes cylinder_reference.csv beside itself
"""
import pathlib

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

# Bore and rod 50/32 mm, valve 40 l/min at 35 bar an edge and 10 V, spool in volts.
A1, A2 = np.pi / 4 * 0.05 ** 2, np.pi / 4 * (0.05 ** 2 - 0.032 ** 2)
PLAIN = dict(m=200.0, d=3000.0, beta=1.2e9, V1=2e-4, V2=3e-4, L=0.5, ps=14e6, pt=3e5,
             qn=40 / 60000, pn=3.5e6, un=10.0, r=1.0, wv=150.0, zeta=0.8, angle=0.0)
# a lift, with a spool cut for unequal areas, leakages, droop, air, a load and a spring
FULL = dict(PLAIN, r=0.6, angle=0.5, internal=5e-12, external=2e-12, droop=5e9, air=0.01,
            force=1500.0, spring=2e4, rest=0.2)
# edges that are open by 0.15 V at null
LAPPED = dict(PLAIN, r=0.6, lap=0.15, force=1500.0)
# throttles of the end cushions, flow at pn; both act along the whole stroke
CUSHIONED = dict(PLAIN, retracted=1e-4, extended=8e-5, force=8000.0)
SCALE = np.array([1e-3, 1e-2, 1e6, 1e6, 1.0, 1e3])


def drawn(k, ps, port, droop):
    """Flow through an edge fed by a supply that gives way: its own quadratic, by iteration."""
    q = k * np.sqrt(ps - port)
    for _ in range(200):
        after = k * np.sqrt(ps - droop * q - port)
        if abs(after - q) < 1e-18:
            break
        q = 0.5 * (q + after)
    return q


def throttled(k, drop, throttle):
    """Flow out through an edge behind a throttle: the pressure between them, by bisection."""
    if throttle is None or drop <= 0 or k == 0:
        return k * np.sign(drop) * np.sqrt(abs(drop))
    g = throttle / np.sqrt(PLAIN["pn"])
    behind = brentq(lambda p: k * np.sqrt(p) - g * np.sqrt(drop - p), 0.0, drop, xtol=1e-9,
                    rtol=1e-14)
    return k * np.sqrt(behind)


def underlapped(s, p1, p2, of):
    """Flows of the four edges, each by itself, into chamber 1 and out of chamber 2."""
    def edge(open_V, drop):
        k = of["qn"] / np.sqrt(of["pn"]) * max(open_V, 0.0) / of["un"]
        return k * np.sign(drop) * np.sqrt(abs(drop))

    lap, r = of["lap"], of["r"]
    return (edge(lap + s, of["ps"] - p1) - edge(lap - s, p1 - of["pt"]),
            r * edge(lap + s, p2 - of["pt"]) - r * edge(lap - s, of["ps"] - p2))


def modulus(p, of):
    absolute = p + 1.01e5
    x = of.get("air", 0.0) * (1.01e5 / absolute) ** (1 / 1.4)
    return of["beta"] * (1 + x) / (1 + x * of["beta"] / (1.4 * absolute))


def rate(_, x, u, of):
    y, v, p1, p2, s, sv = x
    k = of["qn"] / np.sqrt(of["pn"]) * abs(s) / of["un"]
    droop = of.get("droop", 0.0)
    if "lap" in of:
        q1, q2 = underlapped(s, p1, p2, of)
    elif "retracted" in of:
        if s >= 0:
            q1 = -throttled(k, p1 - of["ps"], of["retracted"])
            q2 = throttled(k, p2 - of["pt"], of["extended"])
        else:
            q1 = -throttled(k, p1 - of["pt"], of["retracted"])
            q2 = throttled(k, p2 - of["ps"], of["extended"])
    elif s >= 0:
        q1, q2 = drawn(k, of["ps"], p1, droop), of["r"] * k * np.sqrt(p2 - of["pt"])
    else:
        q1, q2 = -k * np.sqrt(p1 - of["pt"]), -drawn(of["r"] * k, of["ps"], p2, droop)
    across, outside = of.get("internal", 0.0) * (p1 - p2), of.get("external", 0.0)
    load = (of["m"] * 9.80665 * np.sin(of["angle"]) + of.get("force", 0.0)
            + of.get("spring", 0.0) * (y - of.get("rest", 0.0)))
    return [v, (A1 * p1 - A2 * p2 - of["d"] * v - load) / of["m"],
            modulus(p1, of) / (of["V1"] + A1 * y) * (q1 - across - outside * p1 - A1 * v),
            modulus(p2, of) / (of["V2"] + A2 * (of["L"] - y))
            * (A2 * v - q2 + across - outside * p2),
            sv, of["wv"] ** 2 * (u - s) - 2 * of["zeta"] * of["wv"] * sv]


def start(of):
    y = 0.25
    load = (of["m"] * 9.80665 * np.sin(of["angle"]) + of.get("force", 0.0)
            + of.get("spring", 0.0) * (y - of.get("rest", 0.0)))
    p1, p2 = np.linalg.solve([[A1, -A2], [1.0, 1.0]], [load, of["ps"] + of["pt"]])
    return np.array([y, 0.0, p1, p2, 0.0, 0.0])


def open_loop(of, volts):
    """Each voltage for 0.1 s, a row every 10 ms."""
    x, rows = start(of), []
    for k in range(10 * len(volts)):
        u = volts[k // 10]
        rows.append([k * 0.01, u, *x])
        out = solve_ivp(rate, (0.0, 0.01), x, method="DOP853", rtol=1e-12, atol=1e-13 * SCALE,
                        args=(u, of))
        assert out.success
        x = out.y[:, -1]
    return np.array(rows)


def main():
    lines = ["case,t_s,u_V,y_m,v_mps,pressure_in_Pa,pressure_out_Pa,spool_V,spool_Vps"]
    volts = [1.0, -1.0, 0.5, 2.0, 0.5, -1.5, 1.0]
    for name, of in (("plain", PLAIN), ("full", FULL), ("lapped", LAPPED),
                     ("cushioned", CUSHIONED)):
        for row in open_loop(of, volts):
            lines.append(name + "," + ",".join(f"{value:.15g}" for value in row))
    pathlib.Path(__file__).with_name("cylinder_reference.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
