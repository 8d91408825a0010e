"""Modbus TCP over loopback at 200 Hz: spoolwatchd against spoolwatch-rig, beside a bare client.

Prints the round trip of one transaction, the time from the measurement of a position to the command
it led to, and the missed periods; then the round trip of a plain socket that asks the same rig for
the same registers at the same rate. Exit code 1 when p99.9 of the transaction is 1 ms or more.
Usage: latency.py --bin DIR [--seconds S]
"""
import argparse
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time

LIMIT_US = 1000.0


def quantile(values, q):
    return sorted(values)[min(len(values) - 1, int(q * len(values)))]


def daemon(options, address):
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            [f"{options.bin}/spoolwatchd", "--config", "config/bench_modbus.toml", "--lcm-url", "",
             "--duration", str(options.seconds), "--set", f"modbus.address={address}",
             "--set", "loop.overrun_action=count", "--set", "loop.max_bad_in_a_row=1000",
             "--set", f"recorder.folder={folder}/log"],
            capture_output=True, text=True, check=False)
    print(run.stderr.strip())
    if run.returncode != 0:
        sys.exit(f"spoolwatchd ended with {run.returncode}")
    return float(re.search(r"round trip .*?p99\.9 (\d+) us", run.stderr).group(1))


def bare(options, address):
    host, port = address.split(":")
    client = socket.create_connection((host, int(port)))
    client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    request = struct.pack(">HHHBBHH", 1, 0, 6, 1, 3, 4, 8)
    times, due = [], time.monotonic()
    for _ in range(int(200 * options.seconds)):
        due += 0.005
        time.sleep(max(0.0, due - time.monotonic()))
        start = time.monotonic()
        client.sendall(request)
        client.recv(300)
        times.append(1e6 * (time.monotonic() - start))
    print("bare client (Python socket): " + "  ".join(
        f"p{100 * q:g} {quantile(times, q):.0f} us" for q in (0.5, 0.99, 0.999))
        + f"  max {max(times):.0f} us")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", required=True)
    parser.add_argument("--seconds", type=float, default=60.0)
    options = parser.parse_args()
    rig = subprocess.Popen([f"{options.bin}/spoolwatch-rig", "--config", "config/bench_rig.toml",
                            "--listen", "0"], stdout=subprocess.PIPE, text=True)
    try:
        address = rig.stdout.readline().split()[-1]
        p999_us = daemon(options, address)
        bare(options, address)
    finally:
        rig.terminate()
        rig.wait()
    print(f"p99.9 of the transaction: {p999_us:.0f} us, wanted below {LIMIT_US:.0f} us")
    sys.exit(0 if p999_us < LIMIT_US else 1)


main()
