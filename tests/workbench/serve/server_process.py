"""A `spoolwatch serve` for a test, in a folder of its own."""
import http.client
import json
import os
import pathlib
import re
import resource
import signal
import subprocess


class NoPage(Exception):
    """The program was built without the page's libraries."""


class Server:
    def __init__(self, program, folder, *options, environment=None, files=None):
        """`files`: most descriptors that it may have."""
        self.folder = pathlib.Path(folder)
        limit = (lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (files, files))) if files else None
        self.process = subprocess.Popen([program, "serve", "--folder", str(folder), *options], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limit,
                                        env={**os.environ, **(environment or {})})
        self.url = re.match(r"Open (\S+)", self.process.stdout.readline() or "Open none").group(1)
        if self.url == "none":
            why = self.process.stderr.read().strip()
            raise NoPage(why) if "left out" in why else RuntimeError(why)
        self.token = self.url.split("#")[1]
        self.port = int(self.url.split(":")[2].split("/")[0])
        self.cookie = self.change = None

    def ask(self, method, path, body=None, headers=None):
        """Status, headers and JSON of a request as this session's own page would make it."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        all_headers = {"Content-Type": "application/json"}
        if self.cookie:
            all_headers |= {"Cookie": self.cookie, "X-Spoolwatch-Change": self.change or ""}
        connection.request(method, path, None if body is None else json.dumps(body), all_headers | (headers or {}))
        answer = connection.getresponse()
        text = answer.read()
        connection.close()
        try:
            return answer.status, dict(answer.getheaders()), json.loads(text)
        except ValueError:
            return answer.status, dict(answer.getheaders()), text

    def log_in(self):
        _, headers, _ = self.ask("POST", "/api/login", {"token": self.token})
        self.cookie = headers["Set-Cookie"].split(";")[0]
        self.change = self.ask("GET", "/api/state")[2]["change"]
        return self

    def post(self, path, **body):
        status, _, answer = self.ask("POST", "/api/" + path, body)
        if status != 200:
            raise RuntimeError(f"{path}: {status} {answer}")
        return answer

    def state(self):
        return self.ask("GET", "/api/state")[2]

    def resident_kB(self):
        for line in pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines():
            if line.startswith("VmRSS"):
                return int(line.split()[1])
        return 0

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def end(self):
        self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.end()
