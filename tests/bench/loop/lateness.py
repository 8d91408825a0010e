#!/usr/bin/python3
"""Wake-up lateness of the daemon's 200 Hz loop beside cyclictest's, at the same time.

  lateness.py --bin FOLDER --config CONFIG_FOLDER [--runs 5] [--seconds 120] [--parts]

Both run at the same SCHED_FIFO priority and period on the same core, another one in each run, while stress-ng
loads every core: what the host does hits both. The daemon does all its work: simulated rig, parameter tracker, recorder, evidence, LCM with
a listener, and clients that ask at its socket. Prints p50, p99 and p99.9 of each run and the median of the
runs' ratios; exit code 1 where one is above 1.0.

--parts instead finds what the lateness is made of, on idle and on loaded cores: a second cyclictest in the
daemon's place, the daemon with nothing but its loop, and with one kind of work after the other.
"""
import argparse
import contextlib
import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "trouble"))
from stand import Daemon  # noqa: E402

PRIORITY = 80
PERIOD_US = 5000
QUANTILES = {"p50": 0.5, "p99": 0.99, "p99.9": 0.999}
BAR = 1.0
BAR_TICK_US = 20.0
URL = "udpm://239.255.76.67:7683?ttl=0"
WARM_UP_S = 1.0


def quantile_us(histogram, share):
    """Of counts by whole microseconds, rounded down: spread evenly over each."""
    wanted = share * sum(histogram.values())
    below = 0
    for latency_us, count in sorted(histogram.items()):
        if below + count >= wanted:
            return latency_us + (wanted - below) / count
        below += count
    raise SystemExit("lateness: cyclictest counted nothing")


class Cyclictest:
    def __init__(self, seconds, core):
        self.process = subprocess.Popen(
            ["cyclictest", "-q", "-m", "-t1", f"-a{core}", f"-p{PRIORITY}", f"-i{PERIOD_US}", "-h50000",
             f"-l{int(seconds * 1e6) // PERIOD_US}"],
            stdout=subprocess.PIPE, text=True)

    def figures(self):
        text = self.process.communicate()[0]
        rows = re.findall(r"^(\d{6}) (\d{6})", text, re.MULTILINE)
        histogram = {int(a): int(b) for a, b in rows if int(b)}
        return {name: quantile_us(histogram, share) for name, share in QUANTILES.items()}


def closing_report(text):
    """{row: {quantile: us}} of what the daemon writes at its end."""
    rows = {}
    for name, *values in re.findall(
            r"^\s+(lateness|tick)\s+p50 ([\d.]+) us  p99 ([\d.]+) us  p99\.9 ([\d.]+) us", text, re.MULTILINE):
        rows[name] = dict(zip(QUANTILES, map(float, values)))
    if "lateness" not in rows:
        raise SystemExit("lateness: no figures in the daemon's report:\n" + text)
    return rows


class Clients:
    """Three that ask at the socket ten times a second each, and one that listens."""

    def __init__(self, daemon, programs):
        self.ended = threading.Event()
        self.threads = [threading.Thread(target=self.ask, args=(daemon, what))
                        for what in ("status", "status", "alarms")]
        for thread in self.threads:
            thread.start()
        self.listener = subprocess.Popen([programs / "spoolwatch", "listen", "--json", "--lcm-url", URL],
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def ask(self, daemon, what):
        while not self.ended.wait(0.1):
            daemon.ask(what)

    def end(self):
        self.ended.set()
        for thread in self.threads:
            thread.join()
        self.listener.terminate()
        self.listener.wait()


def run(options, config, seconds, core, works=("recorder", "evidence", "clients")):
    """Figures of cyclictest, and the daemon's."""
    settings = [f"loop.cpu={core}", f"loop.priority={PRIORITY}", "loop.privileges=require", "loop.overrun_action=count",
                f"sim.model={options.config / 'models/thesis_calibrated.toml'}"]
    with Daemon(options.bin, config, settings, lcm_url=URL if "clients" in works else "",
                keep=[work for work in works if work != "clients"]) as daemon:
        clients = Clients(daemon, options.bin) if "clients" in works else None
        time.sleep(WARM_UP_S)
        peer = Cyclictest(seconds, core).figures()
        if clients:
            clients.end()
        daemon.end()
        return peer, closing_report(daemon.log.read_text())


class Stress:
    """stress-ng on every core; ends with the `with` block."""

    def __init__(self, seconds):
        self.command = ["stress-ng", "--cpu", str(os.cpu_count()), "--timeout", f"{seconds:.0f}s", "--quiet"]

    def __enter__(self):
        self.process = subprocess.Popen(self.command, stderr=subprocess.DEVNULL, start_new_session=True)

    def __exit__(self, *_):
        os.killpg(self.process.pid, signal.SIGTERM)
        self.process.wait()


def row(peer, lateness):
    return "  ".join(f"{name} {lateness[name]:6.1f} / {peer[name]:6.1f} us = {lateness[name] / peer[name]:4.2f}"
                     for name in QUANTILES)


def compare(options):
    ratios, ticks = {name: [] for name in QUANTILES}, []
    with Stress(options.runs * (options.seconds + 20)):
        for number in range(1, options.runs + 1):
            peer, ours = run(options, options.config / "thesis_case3_named.toml", options.seconds,
                             number % os.cpu_count())
            for name in QUANTILES:
                ratios[name].append(ours["lateness"][name] / peer[name])
            ticks.append(ours["tick"]["p99.9"])
            print(f"  run {number}/{options.runs}: {row(peer, ours['lateness'])}; tick p99.9 {ticks[-1]:.1f} us",
                  flush=True)
    medians = {name: statistics.median(values) for name, values in ratios.items()}
    print(f"median ratio of {options.runs} x {options.seconds} s (bar {BAR}): "
          + ", ".join(f"{name} {value:.2f}" for name, value in medians.items()))
    print(f"tick p99.9, median: {statistics.median(ticks):.1f} us (bar {BAR_TICK_US:.0f})")
    return all(value <= BAR for value in medians.values()) and statistics.median(ticks) < BAR_TICK_US


def twice(options, seconds, core):
    """One cyclictest, and another."""
    one, other = Cyclictest(seconds, core), Cyclictest(seconds, core)
    return one.figures(), {"lateness": other.figures()}


def parts(options):
    tracked = options.config / "thesis_case3_named.toml"
    with tempfile.TemporaryDirectory() as folder:
        bare = pathlib.Path(folder, "bare.toml")
        bare.write_text(tracked.read_text().partition("[[tracker]]")[0])
        rows = {"a second cyclictest": None,
                "loop alone": (bare, ()),
                "with tracker": (tracked, ()),
                "with recorder and evidence too": (tracked, ("recorder", "evidence")),
                "with clients too": (tracked, ("recorder", "evidence", "clients"))}
        for where, load in (("idle", lambda _: contextlib.nullcontext()), ("loaded", Stress)):
            for name, how in rows.items():
                for core in range(os.cpu_count()):
                    print(f"  {where:6} core {core}, {name:30}", end="  ", flush=True)
                    with load(options.seconds + 20):
                        peer, ours = (run(options, how[0], options.seconds, core, how[1]) if how
                                      else twice(options, options.seconds, core))
                    print(row(peer, ours["lateness"]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0],
                                     formatter_class=argparse.RawDescriptionHelpFormatter,
                                     epilog=__doc__.split("\n\n", 1)[1])
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--config", type=pathlib.Path, required=True)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--seconds", type=int, default=120)
    parser.add_argument("--parts", action="store_true")
    options = parser.parse_args()
    print("spoolwatchd / cyclictest, at the same time")
    if options.parts:
        parts(options)
    elif not compare(options):
        sys.exit(1)


if __name__ == "__main__":
    main()
