#!/usr/bin/python3
"""Independent figures for reproduce_test.cpp: the thesis's plant and loop in NumPy, integrated by
classical Runge-Kutta with steps of 0.25 ms (checked against scipy.integrate.solve_ivp), structures
fitted by numpy.linalg.lstsq. Prints reference.h's constants; nothing of the product is used.

  /usr/bin/python3 tests/workbench/reproduce/reference.py > tests/workbench/reproduce/reference.h
"""
import numpy as np
from scipy.integrate import solve_ivp

TS, PSI = 0.005, 6890.0
CD, RHO, W, ZETA, WV, KV = 0.6, 847.0, 2.07e-2, 0.7, 628.0, 2.23939e-5
L, BETA, A, M, V0, KP = 0.61, 6.89e8, 6.33e-4, 50.0, 1e-5, 250.0
FLOW = CD * W * np.sqrt(2.0 / RHO)


def rhs(x, u, ps, d):
    y, v, pi, po, s, sd = x
    out = s >= 0.0
    qi = FLOW * s * np.sqrt(np.maximum(np.where(out, ps - pi, pi), 0.0))
    qo = FLOW * s * np.sqrt(np.maximum(np.where(out, po, ps - po), 0.0))
    return np.array([v, (A * (pi - po) - d * v) / M, BETA / (V0 + A * y) * (qi - A * v),
                     BETA / (V0 + A * (L - y)) * (A * v - qo), sd,
                     -2.0 * ZETA * WV * sd - WV * WV * s + KV * WV * WV * u])


def loop(duration, ps_of, d_of, n, substeps=20):
    """Columns = n runs side by side; u and y (middle position removed) at 200 Hz."""
    x = np.zeros((6, n))
    x[0] = 0.305
    x[2] = x[3] = ps_of(0.0) / 2.0
    h = TS / substeps
    us, ys = [], []
    for k in range(int(round(duration / TS))):
        t = k * TS
        ps, d = ps_of(t), d_of(t)
        u = np.clip(KP * (0.0254 * np.sin(np.pi * t) + 0.305 - x[0]), -10.0, 10.0)
        us.append(u)
        ys.append(x[0] - 0.305)
        for _ in range(substeps):
            k1 = rhs(x, u, ps, d)
            k2 = rhs(x + h / 2 * k1, u, ps, d)
            k3 = rhs(x + h / 2 * k2, u, ps, d)
            k4 = rhs(x + h * k3, u, ps, d)
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(us), np.array(ys)


def rows(u, y, n, m):
    lag = max(n, m)
    cols = [-y[lag - i:len(y) - i] for i in range(1, n + 1)]
    cols += [u[lag - 1 - j:len(u) - 1 - j] for j in range(m)]
    return np.stack(cols, 1), y[lag:]


def fit(u, y, n, m):
    return np.linalg.lstsq(*rows(u, y, n, m), rcond=None)[0]


def free_run(theta, u, y, n, m):
    s = y.copy()
    for t in range(max(n, m), len(y)):
        s[t] = -theta[:n] @ s[t - n:t][::-1] + theta[n:] @ u[t - m:t][::-1]
    return s


def per_period(u, y):
    return [fit(u[400 * p - 1:400 * p + 400], y[400 * p - 1:400 * p + 400], 1, 1)
            for p in range(1, len(y) // 400)]


def check_against_solve_ivp():
    _, y = loop(0.5, lambda t: np.full(1, 1000 * PSI), lambda t: np.full(1, 1000.0), 1)
    x = np.array([0.305, 0, 500 * PSI, 500 * PSI, 0, 0])
    for k in range(100):
        assert abs(x[0] - 0.305 - y[k, 0]) < 1e-9, (k, x[0] - 0.305 - y[k, 0])
        u = KP * (0.0254 * np.sin(np.pi * k * TS) + 0.305 - x[0])
        x = solve_ivp(lambda t, s: rhs(s, u, 1000 * PSI, 1000.0), (0, TS), x, rtol=1e-10,
                      atol=1e-12).y[:, -1]


def main():
    check_against_solve_ivp()
    scale = np.arange(5, 16) / 10.0
    ps = np.concatenate([1000 * PSI * scale, np.full(13, 1000 * PSI)])
    d = np.concatenate([np.full(11, 1000.0), 1000.0 * scale, np.full(2, 1000.0)])

    def schedule(base, lane, t):
        out = base.copy()
        if 15.0 - 1e-9 <= t < 30.0 - 1e-9:
            out[lane] *= 1.25
        elif t >= 45.0 - 1e-9:
            out[lane] *= 0.75
        return out

    u, y = loop(60.0, lambda t: schedule(ps, 22, t), lambda t: schedule(d, 23, t), 24)
    fifth = slice(1600, 2000)
    theta = [fit(u[1599:2000, i], y[1599:2000, i], 1, 1) for i in range(24)]
    normal = theta[5]

    def percent(a, b):
        return 100.0 * (a / b - 1.0)

    out = {"kB1": normal[1],
           "kPressureUp_percent": percent(theta[6][1], normal[1]),
           "kPressureDown_percent": percent(theta[4][1], normal[1]),
           "kDampingUp_percent": percent(theta[17][1], normal[1]),
           "kDampingDown_percent": percent(theta[15][1], normal[1]),
           "kPressureLow": theta[0][1], "kPressureHigh": theta[10][1],
           "kDampingLow": theta[21][1], "kDampingHigh": theta[11][1]}
    for n, m in ((1, 1), (2, 1), (3, 1), (4, 1), (2, 2)):
        uu, yy = u[fifth, 5], y[fifth, 5]
        s = free_run(fit(uu, yy, n, m), uu, yy, n, m)
        out[f"kCost{n}{m}1_m2"] = np.sum((yy - s) ** 2)
        out[f"kCostLate{n}{m}1_m2"] = np.sum((yy[1:] - s[:-1]) ** 2)
    print("// Printed by reference.py. Figures of the thesis's plant and loop by NumPy.\n"
          "#pragma once\n\nnamespace workbench::reproduce::reference {\n")
    for name, value in out.items():
        print(f"inline constexpr double {name} = {value:.9e};")
    for name, lane in (("kCaseOneB1", 22), ("kCaseTwoB1", 23)):
        b1 = {2 * (p + 1): theta_p[1] for p, theta_p in enumerate(per_period(u[:, lane], y[:, lane]),
                                                              start=1)}
        print(f"/// m/V, of the periods that end at 14, 16, 18, 32, 46, 48 s.\n"
              f"inline constexpr double {name}[] = {{"
              + ", ".join(f"{b1[t]:.9e}" for t in (14, 16, 18, 32, 46, 48)) + "};")
    print("\n}  // namespace workbench::reproduce::reference")


main()
