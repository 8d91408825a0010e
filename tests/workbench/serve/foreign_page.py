#!/usr/bin/env python3
"""A hostile page in a real browser that is logged in: nothing that it tries reaches the session.

  foreign_page.py --bin DIR --source DIR      exit code 77: there is no Chromium
"""
import http.server
import sys
import threading

sys.dont_write_bytecode = True
import browser_test  # noqa: E402
from chromium import Browser  # noqa: E402
from server_process import Server  # noqa: E402

PAGE = """<!doctype html><body><iframe id="frame" src="%(ours)s/"></iframe>
<form id="form" method="post" enctype="text/plain" action="%(ours)s/api/model" target="sink">
<input name='{"name":"thesis.toml","x":"' value='"}'></form><iframe name="sink"></iframe></body>"""

TRIES = """(async () => {
  const seen = {};
  const tried = async (name, work) => {
    try { seen[name] = String(await work()); } catch (error) { seen[name] = 'refused'; }
  };
  const ours = '%(ours)s';
  await tried('read', async () => (await fetch(ours + '/api/state', {credentials: 'include'})).text());
  await tried('json', async () => (await fetch(ours + '/api/model', {method: 'POST', credentials: 'include',
    headers: {'Content-Type': 'application/json'}, body: '{"name":"thesis.toml"}'})).status);
  await tried('simple', async () => (await fetch(ours + '/api/model', {method: 'POST', credentials: 'include',
    mode: 'no-cors', body: '{"name":"thesis.toml"}'})).status);
  await tried('events', () => new Promise((done, failed) => {
    const source = new EventSource(ours + '/api/events', {withCredentials: true});
    source.onerror = () => { source.close(); failed(new Error()); };
    source.addEventListener('hello', () => done('events came'));
  }));
  await tried('socket', () => new Promise((done, failed) => {
    const socket = new WebSocket(ours.replace('http', 'ws') + '/api/events');
    socket.onerror = () => failed(new Error());
    socket.onopen = () => done('open');
  }));
  document.getElementById('form').submit();
  await new Promise((done) => setTimeout(done, 500));
  return seen;
})()"""


class Hostile(http.server.BaseHTTPRequestHandler):
    ours = ""

    def do_GET(self):
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write((PAGE % {"ours": self.ours}).encode())

    def log_message(self, *_):
        pass


def attack(args, folder):
    # rebound.example is a name of the attacker that points at this machine.
    with Server(str(args.bin / "spoolwatch"), folder / "session") as server, \
            Browser(resolve="MAP rebound.example 127.0.0.1,MAP evil.example 127.0.0.1") as browser:
        page = browser.page(server.url)
        page.wait("document.body.dataset.ready === 'yes'")
        page.choose("#model", "shipped:velocity_servo.toml")
        page.wait("document.querySelector('#model').value === 'velocity_servo.toml'")
        server.log_in()
        server.post("shipped", name="thesis.toml")
        server.post("model", name="velocity_servo.toml")
        before = server.state()
        hostile = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Hostile)
        threading.Thread(target=hostile.serve_forever, daemon=True).start()
        try:
            for name, ours in (("127.0.0.1", f"http://127.0.0.1:{server.port}"),
                               ("evil.example", f"http://127.0.0.1:{server.port}"),
                               ("evil.example", f"http://rebound.example:{server.port}")):
                Hostile.ours = ours
                other = browser.page(f"http://{name}:{hostile.server_port}/")
                other.wait("document.getElementById('form')")
                seen = other.run(TRIES % {"ours": ours})
                allowed = {"read": "refused", "json": "refused", "simple": "0", "events": "refused",
                           "socket": "refused"}
                for what, value in seen.items():
                    if value not in (allowed[what], "refused"):
                        raise AssertionError(f"{name} against {ours}: {what} gave {value[:200]}")
                # The same site under another port has the same cookie jar; nothing may follow from that.
                if "spoolwatch" in (other.run("document.cookie") or ""):
                    raise AssertionError("the cookie can be read by another page")
            # A page under the attacker's own name whose name then points here has our port as its origin.
            rebound = browser.page(f"http://rebound.example:{server.port}/")
            rebound.wait("document.readyState === 'complete'")
            if rebound.run("document.querySelector('#app') !== null"):
                raise AssertionError("the page is served under another name")
        finally:
            hostile.shutdown()
        after = server.state()
        for key in ("model", "record", "trial", "lineage", "commands"):
            if before[key] != after[key]:
                raise AssertionError(f"{key} has changed: {before[key]} -> {after[key]}")


if __name__ == "__main__":
    sys.exit(browser_test.run(attack))
