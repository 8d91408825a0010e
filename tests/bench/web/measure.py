#!/usr/bin/env python3
"""The page of `spoolwatch serve` in a real headless Chromium: slider to curve, first picture, zoom of a
ten-minute record, the live page's load and memory, many pages, and a client that stops reading.

  measure.py --bin DIR [--seconds S] [workbench|live]...

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
    page.call("HeapProfiler.collectGarbage")
    return page.run("performance.memory.usedJSHeapSize") / 1e6


def workbench(args, folder, figures):
    with Server(str(args.bin / "spoolwatch"), folder / "workbench") as server, Browser() as browser:
        began = time.monotonic()
        page = browser.page(server.url)
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
    url = f"udpm://239.255.76.67:{20000 + os.getpid() % 10000}?ttl=0"
    control = folder / "control.sock"
    daemon = subprocess.Popen(
        [args.bin / "spoolwatchd", "--config", ROOT / "config/demo.toml", "--lcm-url", url,
         "--set", f"control.socket={control}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with Server(str(args.bin / "spoolwatch"), folder / "live", "--lcm-url", url, "--control",
                    str(control)) as server, Browser() as browser:
            page = browser.page(server.url)
            page.wait("document.body.dataset.ready === 'yes'")
            page.choose("#model", "shipped:thesis_calibrated.toml")
            page.wait("document.querySelector('#model').value === 'thesis_calibrated.toml'")
            page.run("document.querySelector('a[href=\"#live\"]').click()")
            page.wait("document.querySelector('.stack') && document.querySelector('.stack').dataset.points > 1500")
            page.call("HeapProfiler.enable")
            leader = browser.process.pid
            before, server_before, began = processes_cpu_s(leader), server.cpu_s(), time.monotonic()
            time.sleep(args.seconds)
            span = time.monotonic() - began
            figures.say("live page, all processes of the browser", 100 * (processes_cpu_s(leader) - before) / span,
                        "%", 15.0)
            figures.say("live page, server", 100 * (server.cpu_s() - server_before) / span, "%", 3.0)
            heaps = []
            for _ in range(3):
                heaps.append(heap_MB(page))
                time.sleep(args.seconds / 4)
            print(f"{'heap of the live page':58} {heaps[-1]:9.2f} MB")

            # A client that opens its stream and never reads.
            server.log_in()
            resident = server.resident_kB()
            stalled = socket.create_connection(("127.0.0.1", server.port))
            stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            stalled.sendall(f"GET /api/events?live HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n"
                            f"Cookie: {server.cookie}\r\n\r\n".encode())
            times = []
            for _ in range(int(20 * args.seconds / 2)):
                began = time.monotonic()
                server.state()
                times.append(1e3 * (time.monotonic() - began))
                time.sleep(0.05)
            figures.say("other requests beside a stalled client, p95", p95(times), "ms", 100.0)
            figures.say("growth of the server by a stalled client", (server.resident_kB() - resident) / 1024, "MB", 8.0)
            stalled.close()

            for _ in range(7):
                browser.page(server.url.split("#")[0])
            time.sleep(2)
            began = time.monotonic()
            last = browser.page(server.url.split("#")[0] + "#live")
            last.wait("document.body.dataset.ready === 'yes'")
            figures.say("ninth page answers after", time.monotonic() - began, "s", 2.0)
    finally:
        daemon.kill()
        daemon.wait()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=lambda text: pathlib.Path(text).resolve(), required=True)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("parts", nargs="*", choices=["workbench", "live", []], default=["workbench", "live"])
    args = parser.parse_args()
    figures = Figures()
    with tempfile.TemporaryDirectory() as folder:
        for part in args.parts:
            {"workbench": workbench, "live": live}[part](args, pathlib.Path(folder), figures)
    return 1 if figures.missed else 0


if __name__ == "__main__":
    sys.exit(main())
