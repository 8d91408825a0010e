#!/usr/bin/env python3
"""Writes numbers.h: what Octave's control package (SLICOT), SciPy and NumPy say about small data
sets. Needs octave-cli with octave-control, python3-scipy.

The data are formulas that C++ repeats to rounding: u and e are runs of one integer generator.
"""
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.optimize import least_squares
from scipy.signal import lfilter

OUT = pathlib.Path(__file__).parent / "numbers.h"
COUNT = 1500
NOISE = 0.1


def lcg(count, seed):
    values = []
    for _ in range(count):
        seed = (seed * 1103515245 + 12345) % 2**31
        values.append(((seed >> 16) % 1024 - 512) / 1024)
    return np.array(values)


U = lcg(COUNT, 11)
E = NOISE * lcg(COUNT, 12)


def delayed(x, k):
    return np.concatenate([np.zeros(k), x[: len(x) - k]])


def armax_data():
    w = lfilter([0.5, 0.3], [1.0], delayed(U, 1)) + lfilter([1.0, -0.8, 0.3], [1.0], E)
    return lfilter([1.0], [1.0, -1.5, 0.7], w)


def box_jenkins_data():
    return (lfilter([0.5, 0.3], [1.0, -1.2, 0.5], delayed(U, 1))
            + lfilter([1.0, 0.5], [1.0, -0.9], E))


def minimise(errors, start):
    fit = least_squares(errors, start, method="lm", xtol=1e-15, ftol=1e-15, gtol=1e-15,
                        max_nfev=20000)
    variance = fit.fun @ fit.fun / (len(fit.fun) - len(start))
    jacobian = fit.jac
    # Central differences: SciPy's own are forward.
    step = 1e-6
    for j in range(len(start)):
        high, low = fit.x.copy(), fit.x.copy()
        high[j] += step
        low[j] -= step
        jacobian[:, j] = (errors(high) - errors(low)) / (2 * step)
    std_error = np.sqrt(variance * np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    return fit.x, std_error, np.sqrt(np.mean(fit.fun**2))


def armax(y):
    """a1 a2 b1 b2 c1 c2; errors from sample 2 on, those before are 0."""
    def errors(x):
        first = 2
        v = np.zeros(COUNT)
        for t in range(first, COUNT):
            v[t] = (y[t] + x[0] * y[t - 1] + x[1] * y[t - 2] - x[2] * U[t - 1] - x[3] * U[t - 2])
        return lfilter([1.0], [1.0, x[4], x[5]], v[first:])
    return minimise(errors, np.array([-1.4, 0.6, 0.5, 0.3, 0.0, 0.0]))


def with_first_values(x, b, f, noise, y):
    """e = noise (y - w), F w = B u; the two first values of w are unknowns, too."""
    w = np.zeros(COUNT)
    w[0], w[1] = x[-2], x[-1]
    drive = b[0] * U[1:-1] + b[1] * U[:-2]
    state = [-f[0] * w[1] - f[1] * w[0], -f[1] * w[1]]
    w[2:], _ = lfilter([1.0], [1.0, f[0], f[1]], drive, zi=state)
    return noise((y - w)[2:])


def output_error(y):
    """b1 b2 f1 f2."""
    def errors(x):
        return with_first_values(x, x[:2], x[2:4], lambda v: v, y)
    return minimise(errors, np.array([0.5, 0.3, -1.2, 0.5, 0.0, 0.0]))


def box_jenkins(y):
    """b1 b2 c1 d1 f1 f2."""
    def errors(x):
        return with_first_values(x, x[:2], x[4:6],
                                 lambda v: lfilter([1.0, x[3]], [1.0, x[2]], v), y)
    return minimise(errors, np.array([0.5, 0.3, 0.5, -0.9, -1.2, 0.5, 0.0, 0.0]))


def octave(y, what):
    """Runs Octave on (u, y); `what` prints numbers, one a line."""
    with tempfile.TemporaryDirectory() as folder:
        np.savetxt(f"{folder}/data.txt", np.column_stack([U, y]), fmt="%.17g")
        script = (f"pkg load control; x = load('{folder}/data.txt'); "
                  f"dat = iddata(x(:,2), x(:,1), 1); {what}")
        run = subprocess.run(["octave-cli", "--quiet", "--eval", script], capture_output=True,
                             text=True, check=False)
    lines = [line for line in run.stdout.split() if line]
    return np.array([float(line) for line in lines])


def instruments(y):
    """Two-stage least squares of ARX(2,2,1) with u(t-1) .. u(t-8) as instruments."""
    rows = range(9, COUNT)
    x = np.array([[-y[t - 1], -y[t - 2], U[t - 1], U[t - 2]] for t in rows])
    z = np.array([[U[t - i] for i in range(1, 9)] for t in rows])
    hat = z @ np.linalg.lstsq(z, x, rcond=None)[0]
    target = y[9:]
    theta = np.linalg.lstsq(hat, target, rcond=None)[0]
    ls = np.linalg.lstsq(x, target, rcond=None)[0]
    rest = (x - hat)[:, :2]  # u is its own instrument
    both = np.column_stack([x, rest])
    e0 = target - x @ ls
    e1 = target - both @ np.linalg.lstsq(both, target, rcond=None)[0]
    statistic = (e0 @ e0 - e1 @ e1) / (e1 @ e1 / (len(target) - 6))
    return theta, ls, statistic


def lines(name, values):
    text = ", ".join(repr(float(v)) for v in np.atleast_1d(values))
    return f"inline constexpr double {name}[] = {{{text}}};\n"


def main():
    out = ["// Written by make_numbers.py: do not edit.\n#pragma once\n\n"
           "namespace estimator::structures::reference {\n\n"]
    y = armax_data()
    for name, fit in (("Armax", armax(y)),
                      ("OutputError", output_error(box_jenkins_data())),
                      ("BoxJenkins", box_jenkins(box_jenkins_data()))):
        theta, error, rms = fit
        out.append(f"// {name}: SciPy's least_squares on errors filtered by lfilter.\n")
        out.append(lines(f"k{name}", theta) + lines(f"k{name}StdError", error)
                   + lines(f"k{name}Rms", rms))
    out.append("// ARX(2,2,1) of the ARMAX data: Octave control, arx(dat, 'na', 2, 'nb', 2); a, b.\n")
    out.append(lines("kOctaveArx", octave(
        y, "s = arx(dat, 'na', 2, 'nb', 2); [b, a] = tfdata(s(1,1), 'v'); "
           "printf('%.17g\\n', a(2:3), b(end-1:end));")))
    state = ("printf('%.17g\\n', real(poly(s.a))(2:3)); h = s.c * s.b; g = s.c * s.a * s.b; "
             "p = poly(s.a); printf('%.17g\\n', h, g + p(2) * h); "
             "q = poly(s.a - i.K * s.c); printf('%.17g\\n', q(2:3));")
    out.append("// Order 2 from the ARMAX data: SLICOT by n4sid and moen4 (s = 15 block rows); a, b, c.\n")
    for name in ("n4sid", "moen4"):
        out.append(lines(f"kOctave_{name}", octave(
            y, f"[s, x0, i] = {name}(dat, 'n', 2, 's', 15, 'confirm', false); {state}")))
    theta, ls, statistic = instruments(y)
    out.append("// Two-stage least squares (NumPy), instruments u(t-1) .. u(t-8).\n")
    out.append(lines("kTwoStage", theta) + lines("kTwoStageLeastSquares", ls)
               + lines("kTwoStageStatistic", statistic))
    out.append("\n}  // namespace estimator::structures::reference\n")
    OUT.write_text("".join(out))


main()
