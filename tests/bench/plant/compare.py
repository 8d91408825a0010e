#!/usr/bin/python3
"""Times SciPy's solve_ivp on the record of plant_bench (ten seconds of closed loop), runs plant_bench,
and prints the ratios.

  compare.py --bin BUILD/bin

solve_ivp runs with RK45, its default, at its default relative tolerance of 1e-3: both errors, of
RK4 and of solve_ivp, against DOP853 at 1e-12, are printed.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "plant_sim"))
from reference import SCALE, THESIS, rate, start  # noqa: E402

SAMPLES = 2000


def run(**options):
    """Position at every 200 Hz sample."""
    x, y = start(THESIS), []
    for k in range(SAMPLES):
        y.append(x[0])
        u = 100.0 * (0.0254 * np.sin(np.pi * k * 0.005) + 0.305 - x[0])
        x = solve_ivp(rate, (0.0, 0.005), x, args=(u, THESIS), **options).y[:, -1]
    return np.array(y)


def rk4():
    """The same method and step as plant_sim, for its accuracy only."""
    x, y, h = start(THESIS), [], 1e-3
    for k in range(SAMPLES):
        y.append(x[0])
        u = 100.0 * (0.0254 * np.sin(np.pi * k * 0.005) + 0.305 - x[0])
        for _ in range(5):
            k1 = np.array(rate(0, x, u, THESIS))
            k2 = np.array(rate(0, x + h / 2 * k1, u, THESIS))
            k3 = np.array(rate(0, x + h / 2 * k2, u, THESIS))
            k4 = np.array(rate(0, x + h * k3, u, THESIS))
            x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array(y)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    bench = parser.parse_args().bin / "plant_bench"
    exact = run(method="DOP853", rtol=1e-12, atol=1e-13 * SCALE)
    print(f"error of RK4 at 1 ms     {np.abs(rk4() - exact).max():.1e} m")
    begin = time.process_time()
    scipy = run(method="RK45", rtol=1e-3, atol=1e-3 * SCALE)
    scipy_s = time.process_time() - begin
    print(f"error of solve_ivp       {np.abs(scipy - exact).max():.1e} m")
    out = subprocess.run([bench, "--benchmark_format=json", "--benchmark_repetitions=5",
                          "--benchmark_report_aggregates_only=true"], check=True,
                         capture_output=True, text=True).stdout
    medians = [b for b in json.loads(out)["benchmarks"] if b["aggregate_name"] == "median"]
    step = {b["run_name"]: b["step"] * 1e9 for b in medians if "step" in b}
    record = {b["run_name"].split("/min_time")[0]: b["cpu_time"] for b in medians
              if "step" not in b}
    ours = step["plant_sim"]
    theirs = step["odeint_runge_kutta4"]
    lanes = step["plant_sim_eight_lanes"]
    print(f"plant_sim                {ours:8.1f} ns per step")
    print(f"plant_sim, eight lanes   {lanes / 8:8.1f} ns per step and lane")
    print(f"all effects at once      {step['plant_sim_every_effect']:8.1f} ns per step,"
          f" {step['plant_sim_every_effect_lanes'] / 8:.1f} per step and lane")
    print(f"odeint runge_kutta4      {theirs:8.1f} ns per step  ({theirs / ours:.2f} x ours)")
    print(f"solve_ivp RK45           {scipy_s * 1e5:8.0f} ns per 1 ms of record"
          f"  ({scipy_s * 1e5 / ours:.0f} x ours)")
    print("a record of 30 s through eight parameter sets, observer included:")
    for name, ms in record.items():
        if name.startswith("ensemble"):
            print(f"  {name[9:].lstrip():32} {ms:7.2f} ms")
    at_once = record["sensitivities in lanes"]
    apart = record["sensitivities by central differences"]
    print(f"model and its seven sensitivities {at_once:.2f} ms; by central differences of the same"
          f" plant {apart:.1f} ms  ({apart / at_once:.1f} x)")
    met = ours <= 100.0 and ours <= theirs and scipy_s * 1e5 >= 100.0 * ours
    print("targets (100 ns, odeint, 100 x solve_ivp):", "met" if met else "MISSED")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
