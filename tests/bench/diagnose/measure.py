#!/usr/bin/python3
"""Times the whole program `spoolwatch diagnose` on records made by spoolwatch-truth.

    measure.py --bin DIRECTORY --truth PROGRAM [--quick]

One hidden effect, two, none, and a record of ten minutes; the best of three runs of each (one of
the long record). Wall and processor time, peak memory, what was found, and when the first ranking
of all effects was known. Bars, on two processors: 3 s with one effect, 10 s with two, 0.5 s until
the ranking, 60 s and 500 MB for ten minutes. Wall time is what the bars are about; on a loaded
machine, which the load average tells, half the processor time is what it would come to at best.
Exit code 1 when a bar is missed or a wrong effect is found.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).parents[3]
MODEL = ROOT / "config/models/thesis.toml"
FRICTION = ("friction.coulomb_N=150,friction.static_N=190,friction.stribeck_mps=0.015,"
            "friction.presliding_stiffness_N_per_m=1e6,friction.bristle_N_s_per_m=3000")
BIAS = "null_bias.offset_V=0.06"
# name, seed, case, effects, seconds, MB
RECORDS = [
    ("friction", 3, f"motion=multisine,{FRICTION}", {"friction"}, 3.0, None),
    ("null_bias", 4, f"motion=sine,{BIAS}", {"null_bias"}, 3.0, None),
    ("deadband", 5, "motion=fast_steps,deadband.half_width_V=0.2", {"deadband"}, 3.0, None),
    ("leakage", 6, "motion=multisine,internal_leakage.conductance_m3ps_per_Pa=3e-11",
     {"internal_leakage"}, 3.0, None),
    ("nothing", 7, "motion=multisine,mismatched=1", set(), 3.0, None),
    ("two effects", 8, f"motion=multisine,{FRICTION},{BIAS}", {"friction", "null_bias"}, 10.0,
     None),
    ("ten minutes", 9, f"motion=multisine,length_s=600,{FRICTION}", {"friction"}, 60.0, 500.0),
]
RANKING_S = 0.5


def once(program, record, out):
    """Wall and processor seconds, MB, answer."""
    begin = time.perf_counter()
    process = subprocess.Popen([program, "diagnose", MODEL, record, "--json", out, "--quiet"],
                               stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{record}: diagnose failed")
    wall = time.perf_counter() - begin
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, json.loads(
        out.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--truth", required=True, type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="one run of each")
    args = parser.parse_args()
    missed = 0
    print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    print("                wall      CPU     peak  ranking")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for title, seed, case, effects, limit_s, limit_MB in RECORDS:
            record = folder / "record.csv"
            subprocess.run([args.truth, "--seed", str(seed), "--case", case, "-o", record],
                           check=True)
            runs = 1 if args.quick or limit_MB else 3
            results = [once(args.bin / "spoolwatch", record, folder / "answer.json")
                       for _ in range(runs)]
            wall, cpu, peak, answer = min(results, key=lambda result: result[0])
            ranking = min(result[3]["preview_s"] for result in results)
            right = set(answer["missing"]) == effects
            met = right and wall < limit_s and (limit_MB is None or peak < limit_MB)
            if limit_MB is None:
                met = met and ranking < RANKING_S
            missed += not met
            bar = f"{limit_s:.0f} s" + (f", {limit_MB:.0f} MB" if limit_MB else "")
            print(f"{title:12} {wall:6.2f} s {cpu:6.2f} s {peak:5.0f} MB {ranking:6.2f} s"
                  f"   {answer['verdict']}: {', '.join(answer['missing']) or '-'}"
                  f"   (bar {bar}: {'met' if met else 'MISSED'})")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
