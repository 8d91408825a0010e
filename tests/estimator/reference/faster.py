#!/usr/bin/env python3
"""Prints the one-step and free-run RMS errors (mm) that measured_record_test.cpp expects.

    faster.py .../faster/faster.csv
"""
import sys

import numpy as np

data = np.genfromtxt(sys.argv[1], delimiter=",", names=True)
u, y = data["u_V"], data["y_mm"]
half = len(y) // 2
for order in range(1, 5):
    def rows(u, y):
        return np.array([[*(-y[t - i] for i in range(1, order + 1)),
                          *(u[t - i] for i in range(1, order + 1)), 1]
                         for t in range(order, len(y))]), y[order:]

    psi, target = rows(u[:half], y[:half])
    theta = np.linalg.lstsq(psi, target, rcond=None)[0]
    psi, target = rows(u[half:], y[half:])
    one_step = np.sqrt(np.mean((target - psi @ theta) ** 2))
    run, late = y[half:].copy(), u[half:]
    for t in range(order, len(run)):
        run[t] = np.r_[-run[t - order:t][::-1], late[t - order:t][::-1], 1] @ theta
    print(order, repr(float(one_step)), repr(float(np.sqrt(np.mean((run - y[half:])[order:] ** 2)))))
