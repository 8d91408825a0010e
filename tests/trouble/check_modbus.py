#!/usr/bin/env python3
"""A misbehaving Modbus device: what it does to the valve.

  check_modbus.py PROGRAMS CONFIG_FOLDER [--line tcp|rtu] [--only TEXT]

The shipped daemon drives the bench rig (spoolwatch-rig) through a proxy that spoils replies in some sixty
ways, once and for half a second, while the rig moves; on a serial line (a pseudo-terminal) in those of them
that there are. Whatever happens: the first command on every new connection is null, a latched daemon moves
nothing, it says why it latched, and it comes back.
"""
import argparse
import os
import pathlib
import socket
import struct
import sys
import tempfile
import threading
import time
import tty

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from modbus_troubles import (COMMAND, ON_ACCEPT, ON_RTU, TROUBLES, WRITES, Close, check_sum, close,  # noqa: E402
                             on_the_line, whole)
from stand import BenchRig, Daemon  # noqa: E402


class Troubled:
    """Spoils replies of the rig while it is asked to, and notes the commands that pass."""

    def __init__(self, rig_port):
        self.rig_port = rig_port
        self.spoil, self.left, self.on_accept = whole, 0, None
        self.deaf = False
        self.first_commands, self.commands, self.first_spoilt = [], [], None
        threading.Thread(target=self.work, daemon=True).start()

    def begin(self, spoil, count):
        self.first_spoilt = None
        self.spoil, self.left = spoil, count

    def note(self, request, first):
        """Whether a command is still to come first."""
        if request[7] not in WRITES or struct.unpack(">H", request[8:10])[0] != COMMAND:
            return first
        volts = struct.unpack(">f", request[13:17])[0]
        self.commands.append((time.monotonic(), volts))
        if first:
            self.first_commands.append(volts)
        return False

    def parts_of(self, request, reply, untouched):
        if self.left == 0:
            return untouched
        parts = self.spoil(request, reply)
        if parts != untouched:
            self.left -= 1
            self.first_spoilt = self.first_spoilt or time.monotonic()
        return parts

    def connect(self):
        rig = socket.create_connection(("127.0.0.1", self.rig_port))
        rig.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return rig

    @staticmethod
    def send(parts, write):
        for ms, data in parts:
            if ms:
                time.sleep(ms * 1e-3)
            write(data)

    @staticmethod
    def frame(file):
        data = b""
        while len(data) < 6 or len(data) < 6 + struct.unpack(">H", data[4:6])[0]:
            part = file.recv(512)
            if not part:
                raise ConnectionError
            data += part
        return data


class Proxy(Troubled):
    def __init__(self, rig_port):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        super().__init__(rig_port)

    def work(self):
        while True:
            client, _ = self.listener.accept()
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            threading.Thread(target=self.serve, args=(client,), daemon=True).start()

    def serve(self, client):
        rig = self.connect()
        first = True
        try:
            if self.on_accept:
                self.on_accept(client)
            while True:
                while self.deaf:
                    time.sleep(0.005)
                request = self.frame(client)
                first = self.note(request, first)
                rig.sendall(request)
                reply = self.frame(rig)
                self.send(self.parts_of(request, reply, [(0, reply)]), client.sendall)
        except Close as end:
            self.left -= 1
            self.first_spoilt = self.first_spoilt or time.monotonic()
            if end.reset:
                client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        except OSError:
            pass
        finally:
            client.close()
            rig.close()


class SerialProxy(Troubled):
    """The rig at the end of a serial line: a pseudo-terminal in place of the wire."""

    def __init__(self, rig_port):
        self.line, self.own_end = os.openpty()  # the own end keeps it open between two owners
        tty.setraw(self.own_end)
        self.name = os.ttyname(self.own_end)
        super().__init__(rig_port)

    def work(self):
        rig = self.connect()
        while True:
            request = self.request()
            while self.deaf:
                time.sleep(0.005)
            self.note(request, False)
            rig.sendall(request)
            reply = self.frame(rig)
            self.send(self.parts_of(request, reply, [(0, on_the_line(reply))]),
                      lambda data: os.write(self.line, data))

    def request(self):
        """The next one with a right check, as a frame of TCP."""
        data = b""
        while True:
            data += os.read(self.line, 256)
            size = 8 if len(data) < 7 or data[1] != 16 else 9 + data[6]
            if len(data) < size:
                continue
            if check_sum(data[:size - 2]) == data[size - 2:size]:
                return struct.pack(">HHH", 1, 0, size - 2) + data[:size - 2]
            data = data[1:]  # begins anew with the next byte


def bench_config(folder, shipped, proxy, more=""):
    """bench_modbus.toml on that proxy, and with more tables; in the folder."""
    text = (shipped / "bench_modbus.toml").read_text()
    place = (f'address = "127.0.0.1:{proxy.port}"' if isinstance(proxy, Proxy)
             else f'serial = "{proxy.name}"\nbaud = 115200\nparity = "none"')
    changed = text.replace('address = "127.0.0.1:1502"', place)
    assert changed != text
    file = pathlib.Path(folder, "bench.toml")
    file.write_text(changed + more)
    return file


def eventually(condition, timeout_s=10.0):
    ends = time.monotonic() + timeout_s
    while time.monotonic() < ends:
        if condition():
            return True
        time.sleep(0.05)
    return False


class Bench:
    def __init__(self, daemon, proxy):
        self.daemon, self.proxy, self.failures = daemon, proxy, []

    def runs(self):
        """In RUN with a command that is far from null."""
        state = self.daemon.ask("status")
        if state["state"] == "LATCHED":
            self.daemon.ask("reset")
        if state["state"] in ("LATCHED", "DISARMED"):
            self.daemon.ask("arm")
        if state["state"] != "RUN":
            self.daemon.ask("start")
            return False
        now = time.monotonic()
        return any(abs(u) > 0.5 and now - t < 0.05 for t, u in self.proxy.commands[-20:])

    def trouble(self, name, begin, end, settle_s=0.5):
        proxy = self.proxy
        if not eventually(self.runs):
            self.failures.append(f"{name}: did not run before: {self.daemon.ask('status')['state']}")
            return
        proxy.first_commands.clear()
        begin()
        time.sleep(settle_s)
        status = self.daemon.ask("status")
        latched = status["state"] == "LATCHED"
        if latched:
            since = time.monotonic()
            time.sleep(0.1)
            moved = [u for t, u in proxy.commands if t > since + 0.02 and u != 0.0]
            if moved:
                self.failures.append(f"{name}: latched, and commands {moved[:3]}")
            if not status["latched_because"]:
                self.failures.append(f"{name}: does not say why it latched")
        end()
        wrong = [u for u in proxy.first_commands if u != 0.0]
        if wrong:
            self.failures.append(f"{name}: a new connection began with {wrong[0]} V")
        back = eventually(self.runs, 15.0)
        if not back:
            self.failures.append(f"{name}: does not come back: {self.daemon.ask('status')}")
        cause = f" by {status['latched_by']}" if latched else ""
        print(f"{name:40} {status['state']}{cause}, {len(proxy.first_commands)} new connections",
              flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("config", type=pathlib.Path)
    parser.add_argument("--line", choices=("tcp", "rtu"), default="tcp")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    on_tcp = options.line == "tcp"
    with BenchRig(options.programs, options.config) as rig, tempfile.TemporaryDirectory() as folder:
        proxy = Proxy(rig.port) if on_tcp else SerialProxy(rig.port)
        troubles = TROUBLES if on_tcp else ON_RTU
        config = bench_config(folder, options.config, proxy)
        settings = ["modbus.timeout_s=0.03",
                    "modbus.watchdog_s=0.3", "modbus.longest_pause_s=0.1", "modbus.read_ahead_s=0",
                    "loop.rate_hz=50", "loop.max_lost_a_minute=1000", "loop.max_lost_in_a_row=50",
                    "reference.amplitude_m=0.05", "loop.overrun_action=count"]
        with Daemon(options.programs, config, settings) as daemon:
            bench = Bench(daemon, proxy)
            memory_kB = daemon.memory_kB()
            tried = 0
            for name, spoil in troubles.items():
                for how, count in (("once", 1), ("half a second", -1)):
                    label = f"{name}, {how}"
                    if options.only not in label:
                        continue
                    bench.trouble(label, lambda: proxy.begin(spoil, count),
                                  lambda: proxy.begin(whole, 0))
                    tried += 1
            for name, meet in (ON_ACCEPT.items() if on_tcp else ()):
                if options.only not in name:
                    continue

                def begin(meet=meet):
                    proxy.on_accept = meet
                    proxy.begin(close(False), 1)

                def end():
                    proxy.on_accept = None
                    proxy.begin(whole, 0)

                bench.trouble(name, begin, end)
                tried += 1
            if options.only in "half open":
                bench.trouble("half open", lambda: setattr(proxy, "deaf", True),
                              lambda: setattr(proxy, "deaf", False))
                tried += 1
            grown_kB = daemon.memory_kB() - memory_kB
            files = len(list(pathlib.Path(f"/proc/{daemon.process.pid}/fd").iterdir()))
            print(f"{tried} troubles, {files} open files, memory grown by {grown_kB} kB")
            if grown_kB > 4096 or files > 40:
                bench.failures.append("memory or files grow")
            if daemon.process.poll() is not None:
                bench.failures.append("the daemon ended")
    print(*bench.failures, sep="\n")
    sys.exit(1 if bench.failures else 0)


if __name__ == "__main__":
    main()
