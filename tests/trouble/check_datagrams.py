#!/usr/bin/env python3
"""Malformed LCM datagrams against every program that listens.

  check_datagrams.py PROGRAMS MODEL [--packets N]

Each listener must outlive them and still take a good message afterwards.
"""
import argparse
import os
import pathlib
import pty
import random
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "workbench/serve"))
from server_process import NoPage, Server  # noqa: E402

GROUP, PORT = "239.255.76.67", 7699
URL = f"udpm://{GROUP}:{PORT}?ttl=0"
KINDS = ("SAMPLE", "RODS", "PRESSURES", "ESTIMATE", "ALARM", "HEALTH")


def fragment(rng, channel):
    """A packet whose sizes, offsets and counts are absurd."""
    edges = (0, 1, 5, 1400, 65535, 0x7FFFFFFF, 0x80000000, 0xFFFFFFF0, 0xFFFFFFFF)
    head = struct.pack(">4sIIIHH", b"LC03", rng.randrange(20), rng.choice(edges),
                       rng.choice(edges), rng.choice((0, 1, 2, 65535)), rng.choice((0, 1, 2, 65535)))
    return head + channel + b"\0" + rng.randbytes(rng.randrange(200))


def short(rng, channel, body):
    return b"LC02" + struct.pack(">I", rng.randrange(1 << 32)) + channel + b"\0" + body


def damaged(rng, body):
    """Flipped bits, cut or prolonged."""
    data = bytearray(body)
    for _ in range(rng.randrange(1, 4)):
        if data:
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    if rng.random() < 0.3:
        del data[rng.randrange(len(data) + 1):]
    return bytes(data) + (rng.randbytes(30) if rng.random() < 0.1 else b"")


def good_packets(programs, config):
    """What a daemon sends."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        one.bind((GROUP, PORT))
        one.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                       socket.inet_aton(GROUP) + socket.inet_aton("0.0.0.0"))
        one.settimeout(10)
        daemon = start_daemon(programs, config)
        try:
            return [one.recv(65536) for _ in range(1500)]
        finally:
            stop(daemon)


def read_away(file):
    """Takes what a terminal shows or a page is sent; a reader that stops is not what is tried here."""
    def take():
        try:
            while os.read(file, 65536):
                pass
        except OSError:
            pass
    threading.Thread(target=take, daemon=True).start()


def live_view(program):
    """`listen --live` in a terminal."""
    shown, terminal = pty.openpty()
    process = subprocess.Popen([program, "listen", "--live", "--lcm-url", URL], stdin=terminal,
                               stdout=terminal, stderr=subprocess.PIPE, env={**os.environ, "TERM": "xterm"})
    os.close(terminal)
    read_away(shown)
    return process


class LivePage:
    """`serve` with a page that watches the stand."""

    def __init__(self, program, folder):
        self.server = Server(program, folder, "--lcm-url", URL).log_in()
        self.events = socket.create_connection(("127.0.0.1", self.server.port))
        self.events.sendall(f"GET /api/events?live HTTP/1.1\r\nHost: 127.0.0.1:{self.server.port}\r\n"
                            f"Cookie: {self.server.cookie}\r\n\r\n".encode())
        self.received = 0
        threading.Thread(target=self.take, daemon=True).start()

    def take(self):
        while part := self.events.recv(65536):
            self.received += len(part)


def start_daemon(programs, config):
    command = [str(programs / "spoolwatchd"), "--config", str(config), "--lcm-url", URL]
    for table in ("control.socket", "alarms.folder", "evidence.folder", "recorder.folder"):
        command += ["--set", f"{table}="]
    return subprocess.Popen(command, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)


def stop(process):
    process.send_signal(signal.SIGTERM)
    process.wait(timeout=20)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("config", type=pathlib.Path)
    parser.add_argument("--packets", type=int, default=20000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = random.Random(options.seed)
    model = options.config.parent / "models/thesis_calibrated.toml"
    program = str(options.programs / "spoolwatch")
    packets = good_packets(options.programs, options.config)
    failed = []
    with tempfile.TemporaryDirectory() as folder:
        listeners = {
            "listen": [program, "listen", "--json", "--lcm-url", URL],
            "record": [program, "record", "-o", f"{folder}/r.csv", "--lcm-url", URL],
            "compare --live": [program, "compare", str(model), "--live", "--json", "-",
                               "--lcm-url", URL],
            "bridge": [program, "bridge", "--udp", "127.0.0.1:9899", "--lcm-url", URL],
        }
        running = {name: subprocess.Popen(command, stdout=subprocess.DEVNULL,
                                          stderr=subprocess.PIPE)
                   for name, command in listeners.items()}
        running["listen --live"] = live_view(program)
        page = None
        try:
            page = LivePage(program, f"{folder}/session")
            running["serve"] = page.server.process
        except NoPage as why:
            print(f"serve: {why}")
        time.sleep(1.0)
        daemon = start_daemon(options.programs, options.config)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
            for i in range(options.packets):
                channel = b"SPOOLWATCH_" + rng.choice(KINDS).encode()
                kind = rng.randrange(4)
                if kind == 0:
                    data = fragment(rng, channel)
                elif kind == 1:
                    data = short(rng, channel, rng.randbytes(rng.randrange(400)))
                else:
                    good = rng.choice(packets)
                    data = good[:8] + damaged(rng, good[8:]) if kind == 2 else damaged(rng, good)
                out.sendto(data[:60000], (GROUP, PORT))
                if i % 50 == 0:
                    time.sleep(0.005)
        time.sleep(1.5)
        if page:
            before = page.received
            time.sleep(2.0)
            if page.received == before:
                failed.append("serve: the page gets nothing more")
        for name, process in running.items():
            if name == "record" and process.poll() == 0:
                # A flipped bit of run_id looks like another daemon, which ends a record in order.
                print("record: ended in order")
                continue
            if process.poll() is not None:
                failed.append(f"{name}: ended with {process.returncode}: "
                              f"{str(process.stderr.read())[-300:]}")
                continue
            rss = [int(line.split()[1]) for line in open(f"/proc/{process.pid}/status")
                   if line.startswith("VmRSS")][0]
            process.send_signal(signal.SIGINT)
            try:
                process.wait(timeout=20)
                print(f"{name}: alive after {options.packets} packets, {rss} kB, "
                      f"exit {process.returncode}")
            except subprocess.TimeoutExpired:
                process.kill()
                failed.append(f"{name}: hangs")
        if daemon.poll() is not None:
            failed.append(f"the daemon ended with {daemon.returncode}")
        stop(daemon)
    print(*failed, sep="\n")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
