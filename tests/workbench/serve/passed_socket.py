"""`spoolwatch serve` on a socket that systemd passes (sd_listen_fds(3)): it serves there, and it
refuses one that another machine could reach, a second one, or one that does not listen."""
import argparse
import os
import pathlib
import re
import socket
import subprocess
import tempfile
import urllib.request


def start(program, folder, listening, count="1", pid="$$"):
    def pass_it():
        os.dup2(listening.fileno(), 3)
        os.set_inheritable(3, True)  # also where it was 3 before

    return subprocess.Popen(
        ["sh", "-c", f'LISTEN_PID={pid} LISTEN_FDS={count} exec "$@"', "sh", program, "serve", "--folder", folder],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, close_fds=False, preexec_fn=pass_it)


def bound(family, address):
    listening = socket.socket(family, socket.SOCK_STREAM)
    listening.bind(address)
    listening.listen()
    return listening


def end(process):
    process.terminate()
    return process.communicate(timeout=20)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    program = parser.parse_args().bin / "spoolwatch"
    with tempfile.TemporaryDirectory() as folder:
        listening = bound(socket.AF_INET, ("127.0.0.1", 0))
        port = listening.getsockname()[1]
        process = start(program, folder, listening)
        line = process.stdout.readline()
        if not line:
            why = process.communicate()[1]
            if "left out" in why:  # built without the page's libraries
                print(why)
                return 77
            raise AssertionError(why)
        assert re.match(rf"Open http://127\.0\.0\.1:{port}/#", line), line
        page = urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=20).read()
        assert b"<html" in page.lower(), page[:80]
        end(process)
        # meant for another process: a port of its own
        process = start(program, folder, listening, pid="1")
        line = process.stdout.readline()
        assert line.startswith("Open ") and f":{port}/" not in line, line
        end(process)

        path = f"{folder}/page.socket"
        with bound(socket.AF_UNIX, path) as unix:
            process = start(program, folder, unix)
            assert "PORT" in process.stdout.readline()
            assert path in process.stdout.readline() + process.stdout.readline()
            end(process)
            assert os.path.exists(path), "the socket of systemd was removed"

        everywhere = bound(socket.AF_INET, ("0.0.0.0", 0))
        silent = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        silent.bind(("127.0.0.1", 0))
        for one, count in ((everywhere, "1"), (silent, "1"), (listening, "2")):
            process = start(program, folder, one, count)
            out, why = process.communicate(timeout=20)
            assert process.returncode == 1 and "socket of systemd" in why and not out, (out, why)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
