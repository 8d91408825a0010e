#!/usr/bin/env python3
"""Batch least squares beside NumPy and Octave, and the on-line estimators beside their limits.

    compare.py --bin DIRECTORY [--rounds N]

DIRECTORY holds the program bench_estimator.

Every program fits ARX(4,4,1) to the same record of 12,000 samples, building the regressors included;
the coefficients must agree. All times are wall time; rounds are interleaved and the fastest of each
program is shown, which leaves out what else the machine does. Exit code 1 when a limit is missed, 2
when the coefficients differ.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

SAMPLES = 12000
HERE = pathlib.Path(__file__).parent


def make_record():
    rng = np.random.default_rng(1)
    u = rng.uniform(-0.5, 0.5, SAMPLES)
    y = np.zeros(SAMPLES)
    noise = 1e-6 * rng.standard_normal(SAMPLES)
    for t in range(4, SAMPLES):
        y[t] = (1.8 * y[t - 1] - 1.2 * y[t - 2] + 0.4 * y[t - 3] - 0.1 * y[t - 4]
                + 2e-4 * (u[t - 1] + u[t - 2] / 2 + u[t - 3] / 3 + u[t - 4] / 4) + noise[t])
    return u, y


def numpy_fit(u, y):
    rows = len(y) - 4
    psi = np.empty((rows, 8))
    for i in range(4):
        psi[:, i] = -y[3 - i:3 - i + rows]
        psi[:, 4 + i] = u[3 - i:3 - i + rows]
    return np.linalg.lstsq(psi, y[4:], rcond=None)[0]


def numpy_seconds(u, y):
    times = []
    for _ in range(20):
        start = time.perf_counter()
        numpy_fit(u, y)
        times.append(time.perf_counter() - start)
    return min(times)


def benchmark_seconds(program, record):
    out = subprocess.run([program, "--benchmark_format=json", "--benchmark_min_time=0.005",
                          "--benchmark_repetitions=15"],
                         env={**os.environ, "SPOOLWATCH_BENCH_RECORD": str(record)},
                         check=True, capture_output=True, text=True)
    rows = [row for row in json.loads(out.stdout)["benchmarks"] if row["run_type"] == "iteration"]
    batch = next(row for row in rows if row["name"].startswith("batch"))
    theta = np.array([batch[name] for name in "a1 a2 a3 a4 b1 b2 b3 b4".split()])
    fastest = {}
    for row in rows:
        name = row["name"].split("/repeats:")[0].removesuffix("/real_time")
        fastest[name] = min(row["per_sample"], fastest.get(name, float("inf")))
    return fastest, theta


def octave_fit(record):
    out = subprocess.run(["octave-cli", "--no-gui", "--quiet", HERE / "octave_arx.m", record],
                         check=True, capture_output=True, text=True).stdout.split("\n")
    return float(out[0]), np.array([float(v) for v in out[1].split()])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    u, y = make_record()
    with tempfile.TemporaryDirectory() as folder:
        record = pathlib.Path(folder) / "record.csv"
        np.savetxt(record, np.column_stack([u, y]), delimiter=",", fmt="%.17g")
        ours, numpy_s, octave_s = [], [], []
        for _ in range(args.rounds):
            times, theta = benchmark_seconds(args.bin / "bench_estimator", record)
            ours.append(times)
            numpy_s.append(numpy_seconds(u, y))
            seconds, octave_theta = octave_fit(record)
            octave_s.append(seconds)
    per_sample = {name: min(o[name] for o in ours) for name in ours[0]}
    batch_s = per_sample["batch_arx441"] * SAMPLES
    numpy_theta = numpy_fit(u, y)
    difference = max(np.max(np.abs(other / numpy_theta - 1.0)) for other in (theta, octave_theta))
    numpy_ratio = min(numpy_s) / batch_s
    octave_ratio = min(octave_s) / batch_s

    good = True

    def line(what, value, limit, met):
        nonlocal good
        good = good and met
        print(f"{what:<46}{value:>16}  {limit:<14}{'met' if met else 'MISSED'}")

    print(f"ARX(4,4,1), {SAMPLES} samples, best of {args.rounds} rounds")
    print(f"{'batch fit':<46}{batch_s * 1e3:>13.3f} ms")
    print(f"{'NumPy lstsq, regressors included':<46}{min(numpy_s) * 1e3:>13.3f} ms")
    print(f"{'Octave arx':<46}{min(octave_s) * 1e3:>13.3f} ms")
    line("batch fit, times faster than NumPy lstsq", f"{numpy_ratio:.1f}", "at least 1", numpy_ratio >= 1)
    line("batch fit, times faster than Octave arx", f"{octave_ratio:.1f}", "at least 20", octave_ratio >= 20)
    for name, value in per_sample.items():
        ns = value * 1e9
        if name.startswith("recursive"):
            line(name, f"{ns:.0f} ns", "under 200 ns", ns < 200)
        elif name.startswith("sliding/update/"):
            line(name, f"{ns:.0f} ns", "under 1000 ns", ns < 1000)
        elif name.startswith("sliding"):
            print(f"{name:<46}{ns:>13.0f} ns")
    print(f"largest relative difference of coefficients {difference:.1e}")
    if difference > 1e-6:
        return 2
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
