"""A headless Chromium driven over its DevTools pipe, with the standard library alone."""
import base64
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time


class Failed(Exception):
    """The page did not do what was waited for."""


def find():
    return shutil.which("chromium")


class Browser:
    """One browser without a network: no name but loopback resolves."""

    def __init__(self, width=1280, height=800, resolve=""):
        self.profile = tempfile.mkdtemp(prefix="spoolwatch_chromium_")
        in_read, self.to = os.pipe()
        self.come, out_write = os.pipe()

        def place():  # Chromium reads 3 and writes 4
            ours = os.dup(in_read), os.dup(out_write)
            os.dup2(ours[0], 3)
            os.dup2(ours[1], 4)

        rules = (resolve + "," if resolve else "") + "MAP * ~NOTFOUND, EXCLUDE 127.0.0.1, EXCLUDE localhost"
        self.process = subprocess.Popen(
            [find(), "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync",
             "--disable-default-apps", "--remote-debugging-pipe", "--enable-precise-memory-info",
             "--host-resolver-rules=" + rules, f"--window-size={width},{height}",
             f"--user-data-dir={self.profile}", "about:blank"],
            preexec_fn=place, close_fds=False, start_new_session=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "HOME": self.profile})
        os.close(in_read)
        os.close(out_write)
        self.bytes = b""
        self.number = 0
        self.events = []

    def call(self, method, session=None, wait_s=60, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + wait_s
        while True:
            answer = self.next(until)
            if answer is None:
                raise Failed(f"{method}: no answer")
            if answer.get("id") == message["id"]:
                if "error" in answer:
                    raise Failed(f"{method}: {answer['error']}")
                return answer["result"]
            if answer.get("method") == "Inspector.targetCrashed":
                raise Failed("the page has crashed")
            self.events.append(answer)

    def next(self, until):
        while b"\0" not in self.bytes:
            left = until - time.monotonic()
            if left <= 0 or not select.select([self.come], [], [], left)[0]:
                return None
            part = os.read(self.come, 1 << 20)
            if not part:
                raise Failed("the browser has ended")
            self.bytes += part
        line, self.bytes = self.bytes.split(b"\0", 1)
        return json.loads(line)

    def page(self, url="about:blank", width=1280, height=800, dark=False, window=False):
        """A tab, which hides the others of its window, or a `window` of its own."""
        target = self.call("Target.createTarget", url="about:blank", newWindow=window)["targetId"]
        session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        return Page(self, session, target, url, width, height, dark)

    def close(self):
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()
        os.close(self.to)
        os.close(self.come)
        shutil.rmtree(self.profile, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Page:
    def __init__(self, browser, session, target, url, width, height, dark):
        self.browser, self.session, self.target = browser, session, target
        for domain in ("Page", "Runtime", "Network", "Log", "DOM", "Performance"):
            self.call(domain + ".enable")
        self.size(width, height, dark)
        if url != "about:blank":
            self.call("Page.navigate", url=url)

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def size(self, width, height, dark=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def run(self, script):
        """The value of an expression; a promise is awaited."""
        out = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in out:
            raise Failed(str(out["exceptionDetails"].get("exception", out["exceptionDetails"])))
        return out["result"].get("value")

    def wait(self, script, wait_s=60):
        """Waits until the expression is true."""
        until = time.monotonic() + wait_s
        while time.monotonic() < until:
            value = self.run("document.body ? Boolean(" + script + ") : false")
            if value:
                return value
            time.sleep(0.05)
        raise Failed(f"waited {wait_s} s for {script}; the page says: "
                     + str(self.run("document.body.innerText"))[:1500])

    def click(self, selector):
        self.wait(f"document.querySelector({json.dumps(selector)})")
        self.run(f"document.querySelector({json.dumps(selector)}).click()")

    def click_text(self, text):
        script = ("[...document.querySelectorAll('button')].find((b) => b.textContent.trim().startsWith("
                  f"{json.dumps(text)}) && !b.disabled)")
        self.wait(f"Boolean({script})")
        self.run(script + ".click()")

    def key(self, selector, key):
        self.run(f"document.querySelector({json.dumps(selector)}).focus()")
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, **({"text": key} if len(key) == 1 else {}))

    def type(self, selector, text, event="input"):
        self.wait(f"document.querySelector({json.dumps(selector)})")
        self.run(f"(() => {{ const s = document.querySelector({json.dumps(selector)}); s.value = {json.dumps(text)};"
                 f" s.dispatchEvent(new Event('{event}', {{bubbles: true}})); }})()")

    def choose(self, selector, value):
        self.wait(f"[...document.querySelectorAll({json.dumps(selector + ' option')})]"
                  f".some((o) => o.value === {json.dumps(value)})")
        self.run(f"(() => {{ const s = document.querySelector({json.dumps(selector)}); s.value = {json.dumps(value)};"
                 " s.dispatchEvent(new Event('change', {bubbles: true})); })()")

    def drop_files(self, selector, files):
        root = self.call("DOM.getDocument")["root"]["nodeId"]
        node = self.call("DOM.querySelector", nodeId=root, selector=selector)["nodeId"]
        self.call("DOM.setFileInputFiles", nodeId=node, files=[os.path.abspath(one) for one in files])

    def drag(self, x0, y0, x1, y1):
        def mouse(kind, x, y, **more):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", **more)
        mouse("mousePressed", x0, y0, clickCount=1)
        for i in range(1, 6):
            mouse("mouseMoved", x0 + (x1 - x0) * i / 5, y0 + (y1 - y0) * i / 5)
        mouse("mouseReleased", x1, y1, clickCount=1)

    def touch(self, begin, end):
        """Fingers that go down at the places `begin`, move to those of `end` in steps, and go up."""
        def fingers(kind, places):
            self.call("Input.dispatchTouchEvent", type=kind,
                      touchPoints=[{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(places)])
        fingers("touchStart", begin)
        for k in range(1, 9):
            fingers("touchMove", [(x0 + (x1 - x0) * k / 8, y0 + (y1 - y0) * k / 8)
                                  for (x0, y0), (x1, y1) in zip(begin, end)])
        fingers("touchEnd", [])

    def picture(self, file, whole=False):
        data = self.call("Page.captureScreenshot", captureBeyondViewport=whole)["data"]
        with open(file, "wb") as out:
            out.write(base64.b64decode(data))

    def said(self):
        """Everything the page complained of, and every address that it asked for."""
        self.run("1")
        wrong, asked = [], []
        for event in self.browser.events:
            if event.get("sessionId") != self.session:
                continue
            method, more = event["method"], event["params"]
            if method == "Runtime.exceptionThrown":
                wrong.append(str(more["exceptionDetails"].get("exception", {}).get("description")))
            elif method == "Log.entryAdded" and more["entry"]["level"] == "error":
                wrong.append(more["entry"]["text"] + " " + more["entry"].get("url", ""))
            elif method == "Network.requestWillBeSent":
                asked.append(more["request"]["url"])
        return wrong, asked
