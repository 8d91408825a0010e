#!/usr/bin/env python3
"""Floods the control socket as a user who may only look, and as members of the group that may act: how long a
`stop` waits.

  check_flood.py PROGRAMS CONFIG [--stops N] [--limit-ms MS] [--processes N] [--only TEXT]

Every stop must be answered within the limit, by a daemon whose memory stays flat, and the audit file must
keep what was ordered. Without root the flood comes from the own user, who may act.
"""
import argparse
import json
import multiprocessing
import os
import pathlib
import socket
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from stand import Daemon  # noqa: E402

NOBODY = 65534
MEMBER = 1  # of the group whose members may act; user and group "daemon"
ORDER = b'{"command": "arm"}\n'


def connection(path):
    one = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    one.setblocking(False)
    try:
        one.connect(path)
    except BlockingIOError:
        pass
    return one


def become(uid):
    """Gives up root's rights for those of a user, and some of the processor."""
    if os.geteuid() == 0 and uid is not None:
        os.setgroups([])
        os.setgid(uid)
        os.setuid(uid)
    os.nice(5)


def pipeline(path, line, ends, uid):
    """Twenty connections that send without reading."""
    become(uid)
    files = []
    while time.monotonic() < ends:
        while len(files) < 20:
            try:
                files.append(connection(path))
            except OSError:
                break
        for one in list(files):
            try:
                one.send(line * 50)
            except BlockingIOError:
                pass
            except OSError:
                one.close()
                files.remove(one)
        time.sleep(0.001)


def answered(path, line, ends, uid):
    """Twenty connections, each of which waits for the answer to one line and comes again."""
    become(uid)
    files = []
    while time.monotonic() < ends:
        try:
            while len(files) < 20:
                files.append(connection(path))
                files[-1].send(line)
        except OSError:
            pass
        for one in list(files):
            try:
                if one.recv(4096) is not None:
                    raise ConnectionError
            except BlockingIOError:
                pass
            except OSError:
                one.close()
                files.remove(one)
        time.sleep(0.0005)


def connections(path, _line, ends, uid):
    """As many connections as there can be, each gone at once."""
    become(uid)
    while time.monotonic() < ends:
        try:
            connection(path).close()
        except OSError:
            time.sleep(0.0005)


FLOODS = {
    "status by a looker": (pipeline, b'{"command": "status"}\n', NOBODY),
    "refused orders by a looker": (pipeline, ORDER, NOBODY),
    "alarms by a looker": (pipeline, b'{"command": "alarms"}\n', NOBODY),
    "half a line": (pipeline, b'{"comm', NOBODY),
    "nonsense": (pipeline, b"\x00\xff{]\n", NOBODY),
    "connections": (connections, b"", NOBODY),
    "status by members": (pipeline, b'{"command": "status"}\n', MEMBER),
    "orders by members": (pipeline, b'{"command": "hold"}\n', MEMBER),
    "alarms by members": (pipeline, b'{"command": "alarms"}\n', MEMBER),
    "notes by members": (pipeline, b'{"command": "note", "text": "' + 300 * b"x" + b'"}\n', MEMBER),
    "reloads by members": (pipeline, b'{"command": "reload"}\n', MEMBER),
    "stops by members": (pipeline, b'{"command": "stop"}\n', MEMBER),
    "answered stops by members": (answered, b'{"command": "stop"}\n', MEMBER),
    "answered orders by members": (answered, b'{"command": "hold"}\n', MEMBER),
    "nonsense by members": (pipeline, b"\x00\xff{]\n", MEMBER),
    "half a line by members": (pipeline, b'{"comm', MEMBER),
    "connections by members": (connections, b"", MEMBER),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs")
    parser.add_argument("config")
    parser.add_argument("--stops", type=int, default=100)
    parser.add_argument("--limit-ms", type=float, default=100.0)
    parser.add_argument("--processes", type=int, default=4, help="of each flood")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    late = 0
    with Daemon(options.programs, options.config,
                ["control.mode=0666", "control.act_group=daemon", "loop.privileges=try"]) as daemon:
        memory_kB = daemon.memory_kB()
        assert daemon.ask("arm")["ok"]
        each = -(-options.stops // len(FLOODS))
        for name, (flood, line, uid) in FLOODS.items():
            if options.only not in name:
                continue
            ends = time.monotonic() + 60
            children = [multiprocessing.Process(target=flood, args=(daemon.socket, line, ends, uid))
                        for _ in range(options.processes)]
            for child in children:
                child.start()
            time.sleep(0.3)
            times_ms = []
            for _ in range(each):
                if "stops" not in name:  # those come before every other order
                    daemon.ask("start")
                begin = time.monotonic()
                answer = daemon.ask("stop")
                times_ms.append(1e3 * (time.monotonic() - begin))
                if answer["state"] == "RUN":
                    print(f"{name}: {answer}")
                    late += 1
                time.sleep(0.02)
            for child in children:
                child.terminate()
                child.join()
            late += sum(t > options.limit_ms for t in times_ms)
            times_ms.sort()
            print(f"{name:28} {len(times_ms)} stops: median {times_ms[len(times_ms) // 2]:6.1f} ms, "
                  f"worst {times_ms[-1]:6.1f} ms", flush=True)
        grown_kB = daemon.memory_kB() - memory_kB
        print(f"memory grown by {grown_kB} kB")
        time.sleep(0.5)
        audit = pathlib.Path(daemon.folder.name, "alarms", "audit.log").read_text()
        arms = [a for a in map(json.loads, audit.splitlines())
                if a["uid"] == os.geteuid() and '"arm"' in a["what"] and a["done"]]
    assert len(arms) == 1, "the audit trail has lost the order that armed the rig"
    assert grown_kB < 8192, "memory grows"
    assert late == 0, f"{late} stops were later than {options.limit_ms} ms"


if __name__ == "__main__":
    main()
