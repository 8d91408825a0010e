#!/usr/bin/env python3
"""Any channel that a stand publishes is drawn: eight at once, pressures among them, which can trigger too.

  channels.py --bin DIR --source DIR [--pictures DIR]      exit code 77: there is no Chromium
"""
import os
import subprocess
import sys

sys.dont_write_bytecode = True
import browser_test  # noqa: E402
from browser_test import expect  # noqa: E402
from chromium import Browser  # noqa: E402
from server_process import Server  # noqa: E402

ALL = {"reference", "y", "u", "u_requested", "error", "supply", "in", "out"}


def drawn(page):
    return page.run("[...document.querySelectorAll('.meters tbody tr')].map((row) => row.innerText.split(/\\t/))")


def watch(args, folder):
    url = f"udpm://239.255.76.67:{20000 + os.getpid() % 10000}?ttl=0"
    daemon = subprocess.Popen(
        [args.bin / "spoolwatchd", "--config", args.source / "config/pressures.toml", "--lcm-url", url, "--duration",
         "120", "--set", f"control.socket={folder}/control.sock", "--set", "loop.overrun_action=count"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        with Server(str(args.bin / "spoolwatch"), folder / "session", "--lcm-url", url, "--control",
                    f"{folder}/control.sock") as server, Browser() as browser:
            page = browser_test.open_live(browser, server.url)
            page.wait("document.querySelector('#channel-supply')")
            there = page.run("[...document.querySelectorAll('.channels input')].map((one) => one.id.slice(8))")
            expect(f"what this stand has: {there}", set(there) == ALL)
            page.wait("document.querySelectorAll('.meters tbody tr').length === 4")
            expect("pressures are not drawn before they are chosen",
                   page.run("document.querySelectorAll('.uplot').length") == 3)

            page.click(".channels summary")
            for key in ("u_requested", "supply", "in", "out"):
                page.click("#channel-" + key)
            page.wait("document.querySelectorAll('.uplot').length === 4")
            page.wait("[...document.querySelectorAll('.meters tbody tr')].every((row) => /[0-9]/.test("
                      "row.children[1].textContent))")
            rows = {row[0]: [float(one) for one in row[1:]] for row in drawn(page)}
            expect(f"eight at once: {rows}", len(rows) == len(ALL))
            low, high = rows["supply pressure, bar"][:2]
            expect(f"the supply is some 69 bar: {low} to {high}", 60 < low <= high < 80)
            low, high = rows["chamber that extends, bar"][:2]
            expect(f"a chamber is between tank and supply: {low} to {high}", 0 < low < high < 80)
            if args.pictures:
                page.picture(args.pictures / "channels.png")
            page.click(".channels summary")

            # The pressure of a chamber triggers; its crossing is in the record that is saved.
            page.choose("#trigger-mode", "single")
            page.choose("#trigger-channel", "in")
            page.wait("document.querySelector('.trigger').innerText.includes('bar')")
            page.choose("#trigger-edge", "either")
            page.type("#trigger-level", str(round((low + high) / 2, 2)), "change")
            page.click_text("Trigger again")
            page.wait("document.querySelector('#trigger-state').textContent === 'captured'", 20)
            page.wait("document.querySelector('.captured')")
            page.click_text("Save capture")
            page.wait("(document.querySelector('.saved') || {innerText: ''}).innerText.includes('.csv')")
            saved = next((folder / "session").glob("capture*.csv")).read_text().splitlines()
            expect(saved[0], all(name in saved[0] for name in ("pressure_in_Pa", "supply_pressure_Pa", "reference_m")))
            column = saved[0].split(",").index("pressure_in_Pa")
            values = [1e-5 * float(line.split(",")[column]) for line in saved[1:]]
            expect("the level is within it", min(values) <= (low + high) / 2 <= max(values))

            # The choice is kept by the browser; the last channel cannot be taken away.
            page.call("Page.reload")
            page.wait("document.querySelectorAll('.uplot').length === 4")
            for key in ALL - {"supply"}:
                page.click("#channel-" + key)
            page.wait("document.querySelectorAll('.uplot').length === 1")
            expect("one stays", page.run("document.querySelector('#channel-supply').disabled"))
            wrong, _ = page.said()
            expect(f"nothing is complained of: {wrong}", not wrong)
    finally:
        daemon.kill()
        daemon.wait()


if __name__ == "__main__":
    sys.exit(browser_test.run(watch))
