#!/usr/bin/python3
"""Wake-up lateness of the daemon's 200 Hz loop beside cyclictest's, both cores loaded by stress-ng.

Interleaved runs at the same SCHED_FIFO priority and period; prints each run's p99.9 and the ratio of
the medians. The daemon runs with all its work: simulated rig, fault detection, LCM, recorder."""

import argparse
import os
import re
import signal
import statistics
import subprocess
import sys
import tempfile

PRIORITY = 80
PERIOD_US = 5000


def percentile_us(histogram, share):
    """Smallest latency that at least `share` of the counted cycles do not exceed."""
    total = sum(histogram.values())
    seen = 0
    for latency_us, count in sorted(histogram.items()):
        seen += count
        if seen >= share * total:
            return latency_us
    raise SystemExit("lateness: cyclictest counted nothing")


def cyclictest_p999_us(seconds):
    loops = seconds * 1_000_000 // PERIOD_US
    text = subprocess.run(
        ["cyclictest", "-q", "-m", "-t1", f"-p{PRIORITY}", f"-i{PERIOD_US}", f"-l{loops}", "-h20000"],
        check=True, capture_output=True, text=True).stdout
    rows = re.findall(r"^(\d{6}) (\d{6})", text, re.MULTILINE)
    return percentile_us({int(a): int(b) for a, b in rows if int(b)}, 0.999)


def daemon_figures(binary, config, seconds):
    """The daemon's closing report: lateness and execution times, in microseconds."""
    with tempfile.TemporaryDirectory() as folder:
        out = subprocess.run(
            [binary, "--config", config, "--duration", str(seconds),
             "--lcm-url", "udpm://239.255.76.67:7683?ttl=0",
             "--set", f"recorder.folder={folder}", "--set", f"loop.priority={PRIORITY}",
             "--set", "loop.privileges=require"],
            check=True, capture_output=True, text=True)
    figures = {}
    for name, p999 in re.findall(r"^\s*(\w+)\b.*?p99\.9 ([\d.]+) us", out.stdout + out.stderr, re.MULTILINE):
        figures[name] = float(p999)
    if "lateness" not in figures:
        raise SystemExit("lateness: no figures in the daemon's report:\n" + out.stdout + out.stderr)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--binary", required=True)
    parser.add_argument("--config", required=True)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=int, default=120)
    arguments = parser.parse_args()

    budget = 2 * arguments.runs * (arguments.seconds + 10)
    stress = subprocess.Popen(["stress-ng", "--cpu", str(os.cpu_count()), "--timeout", f"{budget}s", "--quiet"],
                              stderr=subprocess.DEVNULL, start_new_session=True)
    ours, peer, tick = [], [], []
    try:
        for run in range(arguments.runs):
            peer.append(cyclictest_p999_us(arguments.seconds))
            figures = daemon_figures(arguments.binary, arguments.config, arguments.seconds)
            ours.append(figures["lateness"])
            tick.append(figures["tick"])
            print(f"  run {run + 1}/{arguments.runs}: lateness p99.9 cyclictest {peer[-1]:6.1f} us, "
                  f"spoolwatchd {ours[-1]:6.1f} us; tick p99.9 {tick[-1]:5.1f} us", flush=True)
    finally:
        os.killpg(stress.pid, signal.SIGTERM)
        stress.wait()
    ratio = statistics.median(ours) / statistics.median(peer)
    print(f"lateness p99.9, median of {arguments.runs} x {arguments.seconds} s: cyclictest "
          f"{statistics.median(peer):.1f} us, spoolwatchd {statistics.median(ours):.1f} us, "
          f"ratio {ratio:.2f} (bar 1.2)")
    print(f"tick p99.9, median: {statistics.median(tick):.1f} us (bar 20)")
    sys.exit(0 if ratio <= 1.2 and statistics.median(tick) < 20 else 1)


if __name__ == "__main__":
    main()
