#!/usr/bin/python3
"""Times `spoolwatch fit` beside SciPy's least_squares on the same model compiled from C.

    compare.py --bin DIRECTORY --truth PROGRAM [--rounds N]

DIRECTORY holds spoolwatch, PROGRAM is spoolwatch-truth. Both fit eight parameters, with the same
bounds, priors, start and residual, to the same record of 30 s at 200 Hz; SciPy simulates with
plant.c (optimised for this machine) and stops at the same relative change of the cost, 1e-7. Of its
methods and scalings the fastest counts. Ours is the fit from one start with identifiability and
standard errors; the whole program's time is printed too. SciPy is told the residual's weight, ours
finds it. Rounds are interleaved and the fastest of each is
shown. Exit code 1 when ours is not at least five times as fast, 2 when the minima differ.
"""
import argparse
import ctypes
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.optimize import least_squares

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[2]
NAMES = ("mass_kg", "damping_N_s_per_m", "bulk_modulus_Pa", "dead_volume_m3", "supply_pressure_Pa",
         "valve_gain_m_per_V", "valve_natural_frequency_rad_per_s", "valve_damping_ratio")
START = np.array([50.0, 1000.0, 6.89e8, 1e-5, 6.89e6, 2.79e-5, 628.0, 0.70])
PRIOR_SD = np.array([0.05, 0.2, 0.1, 0.2, 0.03, 0.5, 0.07, 0.1])
SAMPLE_S, STEPS, OBSERVER_PER_S, SETTLING_S = 0.005, 5, 2.0, 0.5
LEADING_PER_S = 20.0  # while it settles: the record begins in the midst of a motion
TOLERANCE = 1e-7
TARGET = 5.0


def compiled(folder):
    library = folder / "plant.so"
    subprocess.run(["cc", "-O3", "-march=native", "-shared", "-fPIC", "-o", library,
                    HERE / "plant.c", "-lm"], check=True)
    function = ctypes.CDLL(str(library)).residuals
    array = np.ctypeslib.ndpointer(dtype=np.float64, flags="C")
    function.argtypes = [array, ctypes.c_int, ctypes.c_double, ctypes.c_int, ctypes.c_double,
                         ctypes.c_int, ctypes.c_double, array, array, array]
    function.restype = None
    return function


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--truth", required=True, type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=7)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        return run(args, pathlib.Path(name))


def run(args, folder):
    record, out = folder / "record.csv", folder / "fit.json"
    subprocess.run([args.truth, "--seed", "11", "--case", "motion=multisine,mismatched=1",
                    "-o", record], check=True)
    command = [args.bin / "spoolwatch", "fit", ROOT / "config/models/thesis.toml", record,
               "-o", folder / "fitted.toml", "--json", out, "--starts", "1", "--profile", "none"]

    def ours():
        begin = time.perf_counter()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return time.perf_counter() - begin, json.loads(out.read_text())["fit_s"]

    ours()  # warm
    fitted = json.loads(out.read_text())
    sigma = fitted["sigma_m"]
    _, u, y = np.loadtxt(record, delimiter=",", skiprows=1).T
    u, y = np.ascontiguousarray(u), np.ascontiguousarray(y)
    function = compiled(folder)
    residual = np.empty(len(y))
    first = round(SETTLING_S / SAMPLE_S)
    count = 0

    def cost_terms(x):
        nonlocal count
        count += 1
        function(START * np.exp(x), len(y), SAMPLE_S, STEPS, OBSERVER_PER_S, first,
                 LEADING_PER_S, u, y, residual)
        return np.concatenate([residual[first:] / sigma, x / PRIOR_SD])

    def peer(**how):
        nonlocal count
        count = 0
        begin = time.perf_counter()
        result = least_squares(cost_terms, np.zeros(8), bounds=(-3.0 * PRIOR_SD, 3.0 * PRIOR_SD),
                               ftol=TOLERANCE, **how)
        return time.perf_counter() - begin, result

    ways = [{"method": m, "x_scale": s} for m in ("trf", "dogbox")
            for s in ("jac", PRIOR_SD)]
    ways = [w for w in ways if peer(**w)[1].success]
    way = min(ways, key=lambda w: peer(**w)[0])
    mine, theirs = [], []
    for _ in range(args.rounds):
        mine.append(ours())
        seconds, best = peer(**way)
        theirs.append(seconds)
    begin = time.perf_counter()
    cost_terms(best.x)
    once = time.perf_counter() - begin
    found = np.array([fitted["parameters"][n]["value"] for n in NAMES])
    errors = np.array([fitted["parameters"][n]["std_error"] for n in NAMES])
    apart = np.abs(found - START * np.exp(best.x)) / errors
    costs = 2.0 * best.cost, np.sum(cost_terms(np.log(found / START)) ** 2)
    whole, alone = (min(column) for column in zip(*mine))
    ratio = min(theirs) / alone
    print(f"spoolwatch fit           {alone * 1e3:8.1f} ms, the whole program {whole * 1e3:.1f} ms"
          f" ({fitted['evaluations']} groups of simulations)")
    print(f"least_squares ({way['method']:6s})   {min(theirs) * 1e3:8.1f} ms"
          f" ({count - 1} simulations of {once * 1e3:.2f} ms)")
    print(f"cost                     {costs[1]:12.4f} ours, {costs[0]:12.4f} SciPy;"
          f" parameters within {apart.max():.3f} standard errors")
    print(f"ratio                    {ratio:8.1f}   (target {TARGET:.0f}):",
          "met" if ratio >= TARGET else "MISSED")
    if apart.max() > 0.1 or costs[1] > costs[0] + 0.1:
        print("the minima differ")
        return 2
    return 0 if ratio >= TARGET else 1


if __name__ == "__main__":
    sys.exit(main())
