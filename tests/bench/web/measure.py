#!/usr/bin/env python3
"""The page of `spoolwatch serve` in a real headless Chromium: slider to curve, first picture, zoom of a
ten-minute record, the live page's load, many windows, a client that stops reading, the loop's lateness
with and without all that, and the page's memory over eight hours of samples.

  measure.py --bin DIR [--seconds S] [--soak-minutes M] [workbench|live|lateness|soak]...

soak: what eight hours of a stand send, in ten minutes (48 times as fast); --soak-minutes: a stand in
real time instead.

Prints one line per figure with its bar; the exit code is 1 where a bar is missed.
"""
import argparse
import math
import os
import pathlib
import socket
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tests/workbench/serve"))
from chromium import Browser  # noqa: E402
from health import Health  # noqa: E402
from server_process import Server  # noqa: E402

SLIDE = """(async () => {
  const slider = document.getElementById('parameter-damping_N_s_per_m'), stack = document.querySelector('.stack');
  const times = [];
  for (let i = 0; i < %d; ++i) {
    const before = stack.dataset.drawn, began = performance.now();
    slider.value = 300 + (i * 37) %% 400;
    slider.dispatchEvent(new Event('input', {bubbles: true}));
    while (stack.dataset.drawn === before) await new Promise((done) => setTimeout(done, 1));
    await new Promise((done) => requestAnimationFrame(done));
    times.push(performance.now() - began);
  }
  return times;
})()"""
LONG_TASKS = """(() => { window.longest = 0;
  new PerformanceObserver((list) => { for (const e of list.getEntries()) {
    window.longest = Math.max(window.longest, e.duration); } }).observe({type: 'longtask'}); })()"""


def p95(values):
    return sorted(values)[min(len(values) - 1, math.ceil(0.95 * len(values)) - 1)]


class Figures:
    missed = False

    def say(self, what, value, unit, bar):
        good = value <= bar
        self.missed = self.missed or not good
        print(f"{what:58} {value:9.2f} {unit:4} bar {bar:g}{'' if good else '   MISSED'}", flush=True)


def processes_cpu_s(leader):
    """CPU time of every process of a browser's group."""
    total = 0
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[2]) == leader:
            total += int(fields[11]) + int(fields[12])
    return total / os.sysconf("SC_CLK_TCK")


def heap_MB(page):
    """Of the page and of the worker that holds the event stream, after a collection, with typed arrays."""
    browser, total = page.browser, 0
    sessions = [page.session]
    for target in browser.call("Target.getTargets")["targetInfos"]:
        if target["type"] == "shared_worker":
            sessions.append(browser.call("Target.attachToTarget", targetId=target["targetId"],
                                         flatten=True)["sessionId"])
    for session in sessions:
        browser.call("HeapProfiler.collectGarbage", session)
        usage = browser.call("Runtime.getHeapUsage", session)
        total += usage["usedSize"] + usage.get("backingStorageSize", 0)
    for session in sessions[1:]:
        browser.call("Target.detachFromTarget", sessionId=session)
    return total / 1e6


class Daemon:
    """A stand in real time; its messages over LCM."""

    def __init__(self, args, folder, config="demo"):
        self.url = f"udpm://239.255.76.67:{20000 + os.getpid() % 10000}?ttl=0"
        self.control = folder / "control.sock"
        self.process = subprocess.Popen(
            [args.bin / "spoolwatchd", "--config", ROOT / f"config/{config}.toml", "--lcm-url", self.url,
             "--set", f"control.socket={self.control}", "--set", "loop.overrun_action=count"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


def live_page(browser, server, window=False):
    page = browser.page(server.url.split("#")[0] + "#live" if server.cookie else server.url, window=window)
    page.wait("document.body.dataset.ready === 'yes'")
    if not server.cookie:
        server.log_in()
        server.post("shipped", name="thesis_calibrated.toml")
        page.run("document.querySelector('a[href=\"#live\"]').click()")
    return page


def stall(server):
    """A client that opens its stream and never reads."""
    stalled = socket.socket()
    stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    stalled.connect(("127.0.0.1", server.port))
    stalled.sendall(f"GET /api/events?live HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n"
                    f"Cookie: {server.cookie}\r\n\r\n".encode())
    return stalled


def workbench(args, folder, figures):
    with Server(str(args.bin / "spoolwatch"), folder / "workbench") as server, Browser() as browser:
        page = browser.page()
        began = time.monotonic()
        page.call("Page.navigate", url=server.url)
        page.wait("document.body.dataset.ready === 'yes'")
        figures.say("first picture after the page is opened", time.monotonic() - began, "s", 1.0)
        page.drop_files("#upload", [ROOT / "config/tour/multisine.csv"])
        page.choose("#model", "shipped:thesis.toml")
        page.wait("document.querySelector('.stack').dataset.drawn >= 1")
        page.wait("document.getElementById('parameter-damping_N_s_per_m')")
        page.run(SLIDE % 20)
        times = page.run(SLIDE % 200)
        print(f"{'slider to new curve, median of 200 moves':58} {statistics.median(times):9.2f} ms")
        figures.say("slider to new curve, p95 of 200 moves, 20 s record", p95(times), "ms", 50.0)

        record = folder / "long.csv"
        with open(record, "w") as out:  # ten minutes at 200 Hz
            out.write("t_s,u_V,y_m\n")
            for k in range(120_000):
                t = 0.005 * k
                out.write(f"{t:.3f},{math.sin(3.1 * t) + 0.5 * math.sin(17 * t):.6f},"
                          f"{0.3 + 0.01 * math.sin(3.1 * t) + 5e-6 * (k * 7919 % 3):.6f}\n")
        page.drop_files("#upload", [record])
        page.wait("document.querySelector('#record').value === 'long.csv'", 120)
        page.run(LONG_TASKS)
        page.run("document.querySelector('.stack').scrollIntoView({block: 'center'})")
        box = page.run("(() => { const r = document.querySelector('.u-over').getBoundingClientRect();"
                       " return [r.left, r.top, r.width, r.height]; })()")
        middle = box[1] + box[3] / 2
        for share in (0.5, 0.4, 0.3, 0.5, 0.4):
            count = page.run("Number(document.querySelector('.stack').dataset.drawn)")
            page.drag(box[0] + 0.2 * box[2], middle, box[0] + (0.2 + share) * box[2], middle)
            page.wait(f"Number(document.querySelector('.stack').dataset.drawn) > {count}")
        figures.say("longest pause of the page, zooming ten minutes", page.run("window.longest"), "ms", 50.0)


def live(args, folder, figures):
    with Daemon(args, folder, "pressures") as daemon, \
            Server(str(args.bin / "spoolwatch"), folder / "live", "--lcm-url", daemon.url, "--control",
                   str(daemon.control)) as server, Browser() as browser:
        page = live_page(browser, server)
        page.wait("document.querySelector('.stack') && document.querySelector('.stack').dataset.points > 1500")
        leader = browser.process.pid

        def load(what, bar_browser, bar_server):
            before, server_before, began = processes_cpu_s(leader), server.cpu_s(), time.monotonic()
            time.sleep(args.seconds)
            span = time.monotonic() - began
            figures.say(f"{what}, all processes of the browser", 100 * (processes_cpu_s(leader) - before) / span,
                        "%", bar_browser)
            figures.say(f"{what}, server", 100 * (server.cpu_s() - server_before) / span, "%", bar_server)

        load("live page, four channels", 15.0, 3.0)
        for key in ("u_requested", "supply", "in", "out"):
            page.click("#channel-" + key)
        page.wait("document.querySelectorAll('.meters tbody tr').length === 8")
        load("live page, eight channels", 15.0, 3.0)
        for key in ("u_requested", "supply", "in", "out"):
            page.click("#channel-" + key)

        resident = server.resident_kB()
        stalled = stall(server)
        times = []
        for _ in range(int(20 * args.seconds / 2)):
            began = time.monotonic()
            server.state()
            times.append(1e3 * (time.monotonic() - began))
            time.sleep(0.05)
        figures.say("other requests beside a stalled client, p95", p95(times), "ms", 100.0)
        figures.say("growth of the server by a stalled client", (server.resident_kB() - resident) / 1024, "MB", 8.0)
        stalled.close()

        # A browser opens six connections to a server; all windows are seen.
        began = time.monotonic()
        pages = [page] + [browser.page(server.url.split("#")[0] + "#live", window=True) for _ in range(7)]
        for one in pages:
            one.wait("Number((document.querySelector('.stack') || {dataset: {}}).dataset.points) > 400")
        figures.say("eight windows opened at once, until all have a picture", time.monotonic() - began, "s", 2.0)
        time.sleep(3)
        ages = [one.run("document.querySelector('.age').textContent") for one in pages]
        behind = [float(age.split()[2]) if age.startswith("newest") else math.inf for age in ages]
        figures.say("oldest newest sample of eight windows", max(behind), "s", 1.0)
        load("eight windows at once", 8 * 15.0, 8 * 3.0)


def lateness(args, folder, figures):
    """p99.9 of the loop's wake-ups, by turns without the page and with two windows and a stalled client."""
    found = {"without the page": [], "with two windows and a stalled client": []}
    for turn in range(3):
        for name, values in found.items():
            place = folder / f"lateness-{turn}-{len(values)}-{name.split()[0]}"
            place.mkdir()
            with Daemon(args, place) as daemon, Health(str(args.bin / "spoolwatch"), daemon.url) as health:
                health.next()
                if name == "without the page":
                    time.sleep(args.seconds)
                else:
                    with Server(str(args.bin / "spoolwatch"), place / "session", "--lcm-url", daemon.url,
                                "--control", str(daemon.control)) as server, Browser() as browser:
                        live_page(browser, server)
                        live_page(browser, server, window=True)
                        stalled = stall(server)
                        time.sleep(args.seconds)
                        values.append(health.next())
                        stalled.close()
                        continue
                values.append(health.next())
    for name, values in found.items():
        late = sorted(one["lateness_p999_us"] for one in values)
        print(f"{'lateness p99.9 ' + name:58} {late[1]:9.0f} us   ({late[0]:.0f} to {late[2]:.0f}), "
              f"{sum(one['skipped_periods'] for one in values)} periods skipped")


def recorded(args, folder, hours):
    """An LCM log of a stand in virtual time, and how much faster than it was written it must be played."""
    log = folder / "soak.lcm"
    began = time.monotonic()
    subprocess.run([args.bin / "spoolwatchd", "--config", ROOT / "config/demo.toml", "--clock", "virtual",
                    "--duration", str(3600 * hours), "--lcm-url", f"file://{log}?mode=w", "--set",
                    f"control.socket={folder}/soak.sock"], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    return log, time.monotonic() - began


def soak(args, folder, figures):
    hours, minutes = 8, 10
    real = args.soak_minutes > 0
    if real:
        source, url, control = Daemon(args, folder), None, None
        url, control, minutes = source.url, source.control, args.soak_minutes
        first_s = 600 if minutes > 20 else 60 * minutes / 2
    else:
        log, written_s = recorded(args, folder, hours)
        url, control = f"file://{log}?mode=r&speed={written_s / (60 * minutes):.5f}", folder / "none.sock"
        first_s = 600 * minutes * 60 / (3600 * hours)  # ten minutes of the stand
    try:
        with Server(str(args.bin / "spoolwatch"), folder / "soak", "--lcm-url", url, "--control",
                    str(control)) as server, Browser() as browser:
            page = live_page(browser, server)
            page.wait("document.querySelector('.stack') && document.querySelector('.stack').dataset.points > 500")
            began = time.monotonic()
            heaps = []
            for share in (0.0, 0.25, 0.5, 0.75, 1.0):
                at = began + first_s + share * (60 * minutes - first_s)
                while time.monotonic() < at:
                    time.sleep(min(5, at - time.monotonic() + 0.01))
                    page.browser.events.clear()
                heaps.append(heap_MB(page))
                print(f"{'heap of page and worker':58} {heaps[-1]:9.2f} MB   after "
                      f"{(time.monotonic() - began) / 60:.1f} min; server {server.resident_kB() / 1024:.1f} MB, page "
                      f"'{page.run('document.querySelector(`.age`).textContent')}'", flush=True)
            words = f"{minutes:g} min" if real else f"{hours} h of samples in {minutes} min"
            figures.say(f"heap at the end of {words} beside that after 10 min", 100 * (heaps[-1] / heaps[0] - 1),
                        "%", 10.0)
    finally:
        if real:
            source.__exit__()


PARTS = {"workbench": workbench, "live": live, "lateness": lateness, "soak": soak}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=lambda text: pathlib.Path(text).resolve(), required=True)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--soak-minutes", type=float, default=0.0)
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []], default=["workbench", "live", "lateness"])
    args = parser.parse_args()
    figures = Figures()
    with tempfile.TemporaryDirectory() as folder:
        for part in args.parts:
            PARTS[part](args, pathlib.Path(folder), figures)
    return 1 if figures.missed else 0


if __name__ == "__main__":
    sys.exit(main())
