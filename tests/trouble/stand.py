"""A daemon in a folder of its own with requests on its control socket, and the Modbus bench rig."""
import json
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import threading
import time


class Daemon:
    """spoolwatchd with a configuration of config/; ends with the `with` block.

    keep: of "recorder" and "evidence" those that it writes to, in its own folder; environment: beside that of
    this process.
    """

    def __init__(self, programs, config, settings=(), lcm_url="", keep=(), environment=None):
        self.programs = pathlib.Path(programs)
        self.folder = tempfile.TemporaryDirectory(prefix="spoolwatch-trouble-")
        os.chmod(self.folder.name, 0o755)
        place = pathlib.Path(self.folder.name)
        self.socket = str(place / "control.sock")
        self.log = place / "log.txt"
        command = [str(self.programs / "spoolwatchd"), "--config", str(config), "--lcm-url", lcm_url]
        for setting in (f"control.socket={self.socket}", f"alarms.folder={place}/alarms",
                        *(f"{what}.folder={place / what if what in keep else ''}"
                          for what in ("evidence", "recorder")), *settings):
            command += ["--set", setting]
        self.process = subprocess.Popen(command, stderr=open(self.log, "w"), stdout=subprocess.DEVNULL,
                                        env={**os.environ, **(environment or {})})

    def __enter__(self):
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline:
            try:
                self.ask("status")
                return self
            except OSError:
                if self.process.poll() is not None:
                    raise RuntimeError(self.log.read_text())
                time.sleep(0.05)
        raise RuntimeError("the daemon does not answer")

    def __exit__(self, *_):
        self.end()
        self.folder.cleanup()

    def end(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
            self.process.wait(timeout=20)

    def ask(self, command, timeout_s=5.0, **more):
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as one:
            one.connect(self.socket)  # waits while others fill the queue, as the commands do
            one.settimeout(timeout_s)
            one.sendall(json.dumps({"command": command, **more}).encode() + b"\n")
            line = b""
            while not line.endswith(b"\n"):
                part = one.recv(65536)
                if not part:
                    raise ConnectionError("closed without an answer")
                line += part
        return json.loads(line)

    def memory_kB(self):
        for line in open(f"/proc/{self.process.pid}/status"):
            if line.startswith("VmRSS"):
                return int(line.split()[1])
        return 0


class BenchRig:
    """spoolwatch-rig on a port of loopback; ends with the `with` block."""

    def __init__(self, programs, config):
        self.process = subprocess.Popen(
            [str(programs / "spoolwatch-rig"), "--config", str(config / "bench_rig.toml"),
             "--set", "bus.listen=127.0.0.1:0"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def __enter__(self):
        printed = []
        for line in self.process.stdout:
            printed.append(line)
            if "127.0.0.1:" in line:
                self.port = int(line.split("127.0.0.1:")[1].split()[0].rstrip(".,;"))
                threading.Thread(target=self.process.stdout.read, daemon=True).start()
                return self
        raise RuntimeError("the rig has ended: " + "".join(printed))

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
