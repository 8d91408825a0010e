#!/usr/bin/env python3
"""The process of the page in every kind of trouble, beside a running loop, which must not notice.

  check_page.py PROGRAMS CONFIG IO_FAULTS [--seconds S]

The page is stopped, killed, left without descriptors or disk, and watched by clients that never read. After
each trouble the loop runs as before: state RUN, no tick missing beyond the periods that it counts as
skipped, nothing dropped on the way to the detector; and the page answers again.
"""
import argparse
import json
import os
import pathlib
import shutil
import signal
import socket
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "workbench/serve"))
from health import Health  # noqa: E402
from server_process import NoPage, Server  # noqa: E402
from stand import Daemon  # noqa: E402

RATE_HZ = 200


def watcher(server, read):
    """A client with an event stream of the live page; one that does not read has a small buffer."""
    one = socket.socket()
    if not read:
        one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    one.connect(("127.0.0.1", server.port))
    one.sendall(f"GET /api/events?live HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n"
                f"Cookie: {server.cookie}\r\n\r\n".encode())
    return one


class Page(Server):
    def __init__(self, args, folder, daemon, url, **more):
        super().__init__(str(args.programs / "spoolwatch"), folder, "--lcm-url", url, "--control", daemon.socket,
                         **more)
        self.log_in()

    def answers(self):
        return self.ask("GET", "/api/state")[0] == 200


def stopped(args, folder, daemon, url):
    """SIGSTOP for a while: messages pile up in the system's buffers and are lost there."""
    with Page(args, folder, daemon, url) as page:
        stream = watcher(page, True)
        time.sleep(args.seconds / 3)
        os.kill(page.process.pid, signal.SIGSTOP)
        time.sleep(args.seconds)
        os.kill(page.process.pid, signal.SIGCONT)
        assert page.answers()
        stream.close()


def killed(args, folder, daemon, url):
    page = Page(args, folder, daemon, url)
    stream = watcher(page, True)
    time.sleep(args.seconds / 3)
    page.process.kill()
    page.process.wait()
    stream.close()
    with Page(args, folder, daemon, url) as again:
        assert again.answers()


def without_descriptors(args, folder, daemon, url):
    """Sixty connections against a limit of forty descriptors."""
    with Page(args, folder, daemon, url, files=40) as page:
        many = [socket.create_connection(("127.0.0.1", page.port)) for _ in range(60)]
        time.sleep(args.seconds)
        for one in many:
            one.close()
        time.sleep(0.5)
        assert page.answers()


def without_disk(args, folder, daemon, url):
    """No byte can be written: what was accepted stays, what is refused leaves nothing."""
    with Page(args, folder, daemon, url) as page:
        shutil.copy(args.config / "tour/multisine.csv", folder / "record.csv")
        page.post("record", name="record.csv")
        page.post("shipped", name="thesis.toml")
        accepted = page.state()
    before = {file.name: file.read_bytes() for file in folder.iterdir()}
    environment = {"LD_PRELOAD": str(args.io_faults), "SPOOLWATCH_FAULT": f"write_enospc:{folder}:0"}
    with Page(args, folder, daemon, url, environment=environment) as page:
        for path, body in (("shipped", {"name": "velocity_servo.toml"}), ("add", {"effect": "friction"}),
                           ("report", {}), ("ignore", {"spans": ["1:2"]})):
            status, _, answer = page.ask("POST", "/api/" + path, body)
            assert status in (422, 500), (path, status)
            assert "error" in answer, answer
        status, _, answer = page.ask("POST", "/api/upload?name=more.csv", {"no": "record"},
                                     {"Content-Type": "application/octet-stream"})
        assert status in (422, 500, 507), status
        now = page.state()
        for key in ("record", "model", "trial", "ignored", "lineage"):
            assert now[key] == accepted[key], (key, accepted[key], now[key])
    assert before == {file.name: file.read_bytes() for file in folder.iterdir()}
    with Page(args, folder, daemon, url) as page:
        assert page.state()["model"] == accepted["model"]


def stalled(args, folder, daemon, url):
    """Sixteen clients that never read."""
    with Page(args, folder, daemon, url) as page:
        clients = [watcher(page, False) for _ in range(16)]
        time.sleep(args.seconds)
        grown_kB = -page.resident_kB()
        time.sleep(2 * args.seconds)
        grown_kB += page.resident_kB()
        assert grown_kB < 16 * 2048, f"{grown_kB} kB"
        assert page.answers()
        for one in clients:
            one.close()


TROUBLES = {"nothing": None, "stopped": stopped, "killed": killed, "without descriptors": without_descriptors,
            "without disk": without_disk, "stalled clients": stalled}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("config", type=pathlib.Path)
    parser.add_argument("io_faults", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--seconds", type=float, default=3.0)
    args = parser.parse_args()
    url = f"udpm://239.255.76.67:{20000 + os.getpid() % 10000}?ttl=0"
    with Daemon(args.programs, args.config / "demo.toml", ["loop.overrun_action=count"], lcm_url=url) as daemon, \
            Health(str(args.programs / "spoolwatch"), url) as health, tempfile.TemporaryDirectory() as place:
        for name, trouble in TROUBLES.items():
            folder = pathlib.Path(place) / name.replace(" ", "-")
            folder.mkdir()
            before = health.next()
            if trouble:
                trouble(args, folder, daemon, url)
            else:
                time.sleep(args.seconds)
            after = health.next()
            span_s = 1e-9 * (after["mono_ns"] - before["mono_ns"])
            ticks = after["ticks"] - before["ticks"]
            skipped = after["skipped_periods"] - before["skipped_periods"]
            missing = RATE_HZ * span_s - ticks - skipped
            print(f"{name:20} {span_s:5.1f} s: {ticks} ticks, {skipped} periods skipped, "
                  f"lateness p99.9 {after['lateness_p999_us']:.0f} us")
            state = daemon.ask("status")["state"]
            assert state == "RUN", state
            assert abs(missing) < 3 + 0.002 * ticks, f"{missing} ticks are missing"
            assert after["dropped_samples"] == 0, after["dropped_samples"]
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except NoPage as missing:
        print(missing)
        sys.exit(77)
