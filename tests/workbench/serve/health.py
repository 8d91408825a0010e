"""The newest health message of a daemon, heard over LCM."""
import json
import subprocess
import threading
import time


class Health:
    def __init__(self, program, url):
        self.newest = None
        self.process = subprocess.Popen([program, "listen", "--json", "--lcm-url", url], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.process.stdout:
            message = json.loads(line)
            if message.get("type") == "health":
                self.newest = message

    def next(self, wait_s=10):
        """The next message: {"ticks", "skipped_periods", "dropped_samples", "lateness_p999_us", ...}."""
        before, until = self.newest, time.monotonic() + wait_s
        while self.newest is before:
            if time.monotonic() > until:
                raise RuntimeError("no health message has come")
            time.sleep(0.01)
        return self.newest

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
