#!/usr/bin/python3
"""Memory and processor time of the daemon at 200 Hz with all messages published and recorded."""

import argparse
import os
import subprocess
import sys
import tempfile
import time


def status_kib(pid, key):
    with open(f"/proc/{pid}/status", encoding="ascii") as status:
        for line in status:
            if line.startswith(key + ":"):
                return int(line.split()[1])
    raise SystemExit(f"footprint: no {key} of {pid}")


def cpu_s(pid):
    """User and system time of every thread, from the scheduler's nanosecond counts."""
    total_ns = 0
    for thread in os.listdir(f"/proc/{pid}/task"):
        with open(f"/proc/{pid}/task/{thread}/schedstat", encoding="ascii") as schedstat:
            total_ns += int(schedstat.read().split()[0])
    return total_ns * 1e-9


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--binary", required=True)
    parser.add_argument("--config", required=True)
    parser.add_argument("--seconds", type=int, default=30)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        daemon = subprocess.Popen(
            [arguments.binary, "--config", arguments.config, "--duration", str(arguments.seconds + 6),
             "--lcm-url", "udpm://239.255.76.67:7684?ttl=0", "--set", f"recorder.folder={folder}"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            time.sleep(3)
            start_s, start_cpu_s = time.monotonic(), cpu_s(daemon.pid)
            time.sleep(arguments.seconds)
            share = (cpu_s(daemon.pid) - start_cpu_s) / (time.monotonic() - start_s)
            resident_mb = status_kib(daemon.pid, "VmRSS") * 1024 / 1e6
        finally:
            daemon.terminate()
            daemon.wait()
    print(f"daemon: {resident_mb:.1f} MB resident (bar 25), {100 * share:.2f} % of one core (bar 2)")
    sys.exit(0 if resident_mb < 25 and share < 0.02 else 1)


if __name__ == "__main__":
    main()
