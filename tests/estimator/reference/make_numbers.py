#!/usr/bin/env python3
"""Writes numbers.h: what NumPy, SciPy and exact rational arithmetic say about small data sets.

The data are formulas that C++ repeats bit for bit (integers and divisions by powers of two).
"""
import pathlib
from fractions import Fraction

import numpy as np
import scipy.signal as signal

OUT = pathlib.Path(__file__).parent / "numbers.h"


def lcg(count, seed=1):
    """Uniform integers in [-512, 511] over 1024: exact in binary."""
    values = []
    for _ in range(count):
        seed = (seed * 1103515245 + 12345) % 2**31
        values.append(((seed >> 16) % 1024 - 512) / 1024)
    return np.array(values)


def rows(u, y, n, m, k, constant):
    first = max(n, k + m - 1)
    psi = [[-y[t - i] for i in range(1, n + 1)] + [u[t - k - i] for i in range(m)]
           + ([1] if constant else []) for t in range(first, len(y))]
    return psi, list(y[first:])


def least_squares(u, y, n, m, k, constant):
    psi, target = rows(u, y, n, m, k, constant)
    psi, target = np.array(psi, float), np.array(target, float)
    theta, *_ = np.linalg.lstsq(psi, target, rcond=None)
    residual = target - psi @ theta
    variance = residual @ residual / (len(target) - len(theta))
    std_error = np.sqrt(variance * np.diag(np.linalg.inv(psi.T @ psi)))
    scaled = psi / np.linalg.norm(psi, axis=0)
    return theta, std_error, np.linalg.cond(scaled), np.sqrt(np.mean(residual**2))


def exact(u, y, n, m, k):
    """Normal equations in rational numbers: no rounding at all."""
    psi, target = rows([Fraction(v) for v in u], [Fraction(v) for v in y], n, m, k, False)
    p = n + m
    a = [[sum(r[i] * r[j] for r in psi) for j in range(p)]
         + [sum(r[i] * t for r, t in zip(psi, target))] for i in range(p)]
    for i in range(p):
        pivot = next(r for r in range(i, p) if a[r][i] != 0)
        a[i], a[pivot] = a[pivot], a[i]
        a[i] = [v / a[i][i] for v in a[i]]
        for r in range(p):
            if r != i:
                a[r] = [x - a[r][i] * v for x, v in zip(a[r], a[i])]
    theta = [row[p] for row in a]
    scaled = np.array(psi, float)
    scaled /= np.linalg.norm(scaled, axis=0)
    return [float(v) for v in theta], np.linalg.cond(scaled)


def array(name, values):
    body = ", ".join(repr(float(v)) for v in values)
    return f"inline constexpr double {name}[] = {{{body}}};\n"


def scalar(name, value):
    return f"inline constexpr double {name} = {float(value)!r};\n"


def main():
    text = ("// Written by make_numbers.py: do not edit.\n#pragma once\n\n"
            "namespace estimator::reference {\n\n")

    text += "// u and y: two runs of the generator (seeds 1 and 2), 200 samples, ARX(3,2,2) + constant.\n"
    theta, std_error, condition, rms = least_squares(lcg(200, 1), lcg(200, 2), 3, 2, 2, True)
    text += array("kRandomTheta", theta) + array("kRandomStdError", std_error)
    text += scalar("kRandomCondition", condition) + scalar("kRandomRms", rms) + "\n"

    text += ("// u = (t - 20)^9, y = generator of seed 3, 40 samples, ARX(0,9,1), in exact arithmetic:\n"
             "// shifts of one polynomial, as ill-conditioned as NIST's polynomial problems.\n")
    theta, condition = exact([(t - 20) ** 9 for t in range(40)], lcg(40, 3), 0, 9, 1)
    text += array("kPolynomialTheta", theta) + scalar("kPolynomialCondition", condition) + "\n"

    text += "// SciPy butter(..., output='sos') + sosfilt on generator values (seed 4), settled start.\n"
    x = lcg(64, 4)
    designs = [
        ("LowPass4", (4, 10.0, "lowpass")), ("LowPass5", (5, 30.0, "lowpass")),
        ("HighPass3", (3, 2.0, "highpass")), ("HighPass6", (6, 40.0, "highpass")),
        ("BandPass1", (1, [5.0, 20.0], "bandpass")), ("BandPass3", (3, [5.0, 20.0], "bandpass")),
        ("BandPass1Wide", (1, [1.0, 90.0], "bandpass")), ("BandPass8", (8, [10.0, 60.0], "bandpass")),
    ]
    for name, (order, corner, kind) in designs:
        sos = signal.butter(order, corner, kind, fs=200.0, output="sos")
        y, _ = signal.sosfilt(sos, x, zi=signal.sosfilt_zi(sos) * x[0])
        text += array("k" + name, y[::7])
    text += "\n// SciPy detrend (constant, linear) on generator values (seed 5) + 3 + 0.25 t, 50 samples.\n"
    x = lcg(50, 5) + 3 + 0.25 * np.arange(50)
    text += array("kDetrendMean", signal.detrend(x, type="constant"))
    text += array("kDetrendLine", signal.detrend(x, type="linear"))
    text += "\n// Every 4th value of the order 8 low-pass at 0.8 of the new Nyquist frequency (seed 6).\n"
    x = lcg(200, 6)
    sos = signal.butter(8, 0.8 / 4, output="sos")
    y, _ = signal.sosfilt(sos, x, zi=signal.sosfilt_zi(sos) * x[0])
    text += array("kDecimated4", y[::4])
    OUT.write_text(text + "\n}  // namespace estimator::reference\n")


if __name__ == "__main__":
    main()
