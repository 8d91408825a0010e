#!/usr/bin/env python3
"""The time to null under each trouble of the misbehaving Modbus device, against what --check states.

  measure_null.py PROGRAMS CONFIG_FOLDER [--line tcp|rtu] [--action latch|ramp] [--only TEXT] [--runs N]

The device of check_modbus.py spoils every reply (modbus_troubles.py) from a moment on at which the valve is
far from null. A client of its own watches the rig's valve. Prints a line per trouble: row of --check, stated
time, the longest measured one and the state that follows; exit code 1 where the valve was not at null by the
stated time.
"""
import argparse
import collections
import os
import pathlib
import re
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from check_modbus import Bench, Proxy, SerialProxy, bench_config, eventually  # noqa: E402
from modbus_troubles import ON_RTU, TROUBLES, whole  # noqa: E402
from stand import BenchRig, Daemon  # noqa: E402

NULL_V = 0.01  # two steps of the converter
FAR_V = 2.0
WATCHED_S = 0.5
# Replies within their 16 ms, mostly: nothing asks for null, and the command passes through it by itself.
IN_TIME = ("1 ms late", "3 ms late", "8 ms late", "slow, 0.2 ms a byte")
# On a serial line what follows a whole reply is thrown away before the next request.
IN_TIME_ON_RTU = (*IN_TIME, "twice", "trailing byte")
# With a ramp: of the guards whose action may be one, those that a troubled bus trips.
GUARDS = """
[safety]
ramp_s = 0.1
[[guard]]
kind = "e_stop"
action = "{0}"
[[guard]]
kind = "jump"
limit_m = 0.02
action = "{0}"
[[guard]]
kind = "stale"
age_s = 0.1
action = "{0}"
"""
SETTINGS = ["loop.rate_hz=50", "modbus.watchdog_s=0.15", "modbus.timeout_s=0.016",
            "modbus.longest_pause_s=0.1",
            "modbus.read_ahead_s=0", "loop.max_lost_a_minute=1000", "loop.max_lost_in_a_row=50",
            "loop.overrun_action=count", "reference.amplitude_m=0.05"]


def row_of(name):
    """The row of --check that covers a trouble."""
    if name.startswith("e-stop"):
        return "guard e_stop"
    if name.startswith("position") or name.endswith("on reads") and name.startswith("exception"):
        return "position missing"
    if name == "lost on reads":
        return "readings stop"
    return "bus lost"  # the command in the device stands until its time-out, at the longest


class Watcher:
    """What the rig's valve gives, with the times before and after each look."""

    def __init__(self, port):
        self.looks = collections.deque(maxlen=20000)
        self.bus = socket.create_connection(("127.0.0.1", port))
        self.bus.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        threading.Thread(target=self.watch, daemon=True).start()

    def watch(self):
        request = struct.pack(">HHHBBHH", 1, 0, 6, 1, 3, 8, 2)
        while True:
            before = time.monotonic()
            self.bus.sendall(request)
            reply = b""
            while len(reply) < 13:
                reply += self.bus.recv(64)
            self.looks.append((before, time.monotonic(), struct.unpack(">f", reply[9:13])[0]))
            time.sleep(0.0005)

    def moves_out(self):
        """Far from null, and on the way further out."""
        looks = list(self.looks)[-80:]
        return len(looks) > 60 and abs(looks[-1][2]) > FAR_V and abs(looks[-1][2]) > abs(looks[0][2])

    def time_to_null(self, begin):
        """(more than, less than) in s; None: not within WATCHED_S."""
        last = begin
        for before, after, volts in list(self.looks):
            if after < begin or before > begin + WATCHED_S:
                continue
            if abs(volts) < NULL_V:
                return last - begin, after - begin
            last = max(begin, before)
        return None


def be_prompt(yes):
    """Real-time priority, where it may be had, for what this thread starts: a device is no program that waits
    for others."""
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO if yes else os.SCHED_OTHER, os.sched_param(20 if yes else 0))
    except PermissionError:
        pass


def stated(programs, config, settings):
    """{row: s} of --check."""
    command = [str(programs / "spoolwatchd"), "--config", str(config), "--check", "--lcm-url", ""]
    for setting in settings:
        command += ["--set", setting]
    printed = subprocess.run(command, capture_output=True, text=True).stdout
    rows = {}
    for line in printed.splitlines():
        found = re.match(r"# (.{24}) modbus +([0-9.]+) ", line)
        if found:
            rows[found[1].strip()] = float(found[2]) * 1e-3
    return rows


class Measurement:
    def __init__(self, daemon, proxy, watcher, rows, in_time):
        self.daemon, self.proxy, self.watcher, self.rows = daemon, proxy, watcher, rows
        self.in_time = in_time
        self.bench = Bench(daemon, proxy)
        self.failures = []

    def once(self, name, spoil):
        """(more than, less than, state) or None."""
        if not eventually(self.bench.runs, 40.0) or not eventually(self.watcher.moves_out, 40.0):
            self.failures.append(f"{name}: does not move before: {self.daemon.ask('status')['state']}, "
                                 f"valve at {self.watcher.looks[-1][2]:.2f} V")
            return None
        self.proxy.begin(spoil, -1)
        time.sleep(WATCHED_S + 0.1)
        state = self.daemon.ask("status")["state"]
        begin = self.proxy.first_spoilt
        self.proxy.begin(whole, 0)
        if begin is None:
            self.failures.append(f"{name}: no reply was spoilt")
            return None
        found = self.watcher.time_to_null(begin)
        return (*found, state) if found else (None, None, state)

    def measure(self, name, spoil, runs):
        row = row_of(name)
        seen = [one for one in (self.once(name, spoil) for _ in range(runs)) if one]
        if not seen:
            return
        never = [one for one in seen if one[1] is None]
        state = ", ".join(sorted({one[2] for one in seen}))
        if name in self.in_time:
            print(f"{name} | - | - | - | {state}", flush=True)
            return
        if never:
            self.failures.append(f"{name}: not at null within {WATCHED_S} s, {state}")
            return
        least, most = max((one[:2] for one in seen), key=lambda one: one[1])
        latest = max(one[0] for one in seen)
        if latest > self.rows[row]:
            self.failures.append(f"{name}: null after {latest * 1e3:.1f} ms, stated "
                                 f"{self.rows[row] * 1e3:.1f} ({row})")
        print(f"{name} | {row} | {self.rows[row] * 1e3:.1f} | {least * 1e3:.1f} to "
              f"{most * 1e3:.1f} | {state}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("config", type=pathlib.Path)
    parser.add_argument("--line", choices=("tcp", "rtu"), default="tcp")
    parser.add_argument("--action", choices=("latch", "ramp"), default="latch")
    parser.add_argument("--only", default="")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    be_prompt(True)
    with BenchRig(options.programs, options.config) as rig, tempfile.TemporaryDirectory() as folder:
        on_tcp = options.line == "tcp"
        proxy, watcher = (Proxy if on_tcp else SerialProxy)(rig.port), Watcher(rig.port)
        be_prompt(False)
        config = bench_config(folder, options.config, proxy, GUARDS.format(options.action))
        rows = stated(options.programs, config, SETTINGS)
        proxy.commands.clear()
        with Daemon(options.programs, config, SETTINGS) as daemon:
            measurement = Measurement(daemon, proxy, watcher, rows, IN_TIME if on_tcp else IN_TIME_ON_RTU)
            for name, spoil in (TROUBLES if on_tcp else ON_RTU).items():
                if options.only in name:
                    measurement.measure(name, spoil, options.runs)
    print(*measurement.failures, sep="\n", file=sys.stderr)
    sys.exit(1 if measurement.failures else 0)


if __name__ == "__main__":
    main()
