#!/usr/bin/env python3
"""Prints the one-step and free-run RMS errors (V) that measured_record_test.cpp expects of
tests/records/hanging_load.csv: least squares in exact fractions, so that no solver is trusted.
"""
import csv
import fractions
import math
import pathlib

F = fractions.Fraction
path = pathlib.Path(__file__).resolve().parents[2] / "records/hanging_load.csv"
with open(path, encoding="utf-8") as file:
    table = list(csv.DictReader(file))
u = [F(row["u_V"]) for row in table]
y = [F(row["y_V"]) for row in table]


def regressors(u, y, t, order):
    return ([-y[t - i] for i in range(1, order + 1)] + [u[t - i] for i in range(1, order + 1)] + [F(1)])


def solved(a, b):
    rows = [list(row) + [value] for row, value in zip(a, b)]
    for i in range(len(rows)):
        pivot = max(range(i, len(rows)), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for r, row in enumerate(rows):
            if r != i and row[i] != 0:
                rows[r] = [x - row[i] * z for x, z in zip(row, rows[i])]
    return [row[-1] for row in rows]


def rms(errors):
    return math.sqrt(sum(float(e) ** 2 for e in errors) / len(errors))


half = len(y) // 2
for order in (1, 2, 3):
    psi = [regressors(u[:half], y[:half], t, order) for t in range(order, half)]
    width = len(psi[0])
    normal = [[sum(row[i] * row[j] for row in psi) for j in range(width)] for i in range(width)]
    right = [sum(row[i] * y[t + order] for t, row in enumerate(psi)) for i in range(width)]
    theta = solved(normal, right)
    late_u, late_y = u[half:], y[half:]
    one_step = [late_y[t] - sum(a * b for a, b in zip(regressors(late_u, late_y, t, order), theta))
                for t in range(order, len(late_y))]
    fl, fu = [float(x) for x in theta], [float(x) for x in late_u]
    run = [float(x) for x in late_y[:order]]
    for t in range(order, len(late_y)):
        run.append(sum(a * b for a, b in zip([-run[t - i] for i in range(1, order + 1)] +
                                             [fu[t - i] for i in range(1, order + 1)] + [1.0], fl)))
    free = [run[t] - float(late_y[t]) for t in range(order, len(late_y))]
    print(order, repr(rms(one_step)), repr(rms(free)))
