#!/usr/bin/env python3
"""Times a build in a fresh folder without ccache, the tests, and a build after one effect's header
has changed. Beside each: the CPU time that it took, and what the rest of the machine took meanwhile.
"""
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
FOLDER = ROOT / "build/fresh"
HEADER = ROOT / "plant_sim/effects/friction.h"
TICKS_PER_S = os.sysconf("SC_CLK_TCK")


def busy_s():
    """CPU time of the whole machine that was not idle."""
    ticks = [int(x) for x in pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:]]
    user, nice, system, _idle, _wait, irq, softirq, steal = ticks[:8]
    return (user + nice + system + irq + softirq + steal) / TICKS_PER_S


def own_s():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def timed(name, *command):
    log = FOLDER / "measure.log"
    begin, busy, own = time.monotonic(), busy_s(), own_s()
    with open(log, "a", encoding="utf-8") as out:
        status = subprocess.run(command, cwd=ROOT, stdout=out, stderr=out, check=False,
                                env=os.environ | {"CCACHE_DISABLE": "1"}).returncode
    wall, cpu = time.monotonic() - begin, own_s() - own
    others = max(0.0, busy_s() - busy - cpu)
    print(f"{name:<44} {wall:6.1f} s   CPU {cpu:6.1f} s   others {others:6.1f} s", flush=True)
    if status != 0:
        sys.exit(f"{' '.join(command)} failed: see {log}")


def others_now():
    """Processes that use the machine at this moment."""
    lines = subprocess.run(["top", "-b", "-n", "2", "-d", "1", "-w", "200"], capture_output=True,
                           text=True, check=True).stdout.split("\n\n")[-1].split("\n")
    rows = [line.split(None, 11) for line in lines]
    return [f"{r[11]} {r[8]} %" for r in rows
            if len(r) == 12 and r[0].isdigit() and float(r[8]) >= 5.0 and r[11] != "top"]


def main():
    excluded = next(preset for preset in
                    json.loads((ROOT / "CMakePresets.json").read_text())["testPresets"]
                    if preset["name"] == "release")["filter"]["exclude"]["label"]
    cores = len(os.sched_getaffinity(0))
    print(f"{cores} cores; load {os.getloadavg()[0]:.2f} at the start; "
          f"running beside: {', '.join(others_now()) or 'nothing'}")
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    build = ("cmake", "--build", str(FOLDER))
    timed("configuration", "cmake", "--preset", "release", "-B", str(FOLDER))
    timed("product: spoolwatchd and spoolwatch", *build, "--target", "spoolwatchd", "spoolwatch")
    timed("everything else: rig, man pages, tests", *build)
    timed("ctest", "ctest", "--test-dir", str(FOLDER), "-j", str(cores), "--output-on-failure",
          "-LE", excluded)
    HEADER.touch()
    timed(f"after a change to {HEADER.relative_to(ROOT)}", *build)


main()
