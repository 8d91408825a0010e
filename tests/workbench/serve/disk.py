#!/usr/bin/env python3
"""The disk of the session fills up while the page is open: the page says so, a diagnosis that ran meanwhile
is not lost, and everything goes on when there is room again.

  disk.py --bin DIR --source DIR [--pictures DIR]      exit code 77: there is no Chromium, or nothing may be mounted
"""
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
import browser_test  # noqa: E402
from browser_test import expect  # noqa: E402
from chromium import Browser  # noqa: E402
from server_process import Server  # noqa: E402

# A disk of its own, seen by the server alone.
ON_A_SMALL_DISK = """#!/bin/sh
exec unshare --map-root-user --mount sh -c 'mount -t tmpfs -o size=4m tmpfs "$0" && exec "$@"' '{folder}' '{program}' "$@"
"""


def fill(file):
    with open(file, "wb", buffering=0) as out:
        try:
            while True:
                out.write(bytes(4096))
        except OSError:
            pass


def story(args, folder):
    may = ["unshare", "--map-root-user", "--mount", "true"]
    if subprocess.run(may, stderr=subprocess.DEVNULL, check=False).returncode != 0:
        raise browser_test.Skip("nothing may be mounted here")
    session = folder / "session"
    session.mkdir()
    program = folder / "spoolwatch"
    program.write_text(ON_A_SMALL_DISK.format(folder=session, program=args.bin / "spoolwatch"))
    program.chmod(0o755)
    with Server(str(program), session) as server, Browser() as browser:
        disk = pathlib.Path(f"/proc/{server.process.pid}/root{session}")
        page = browser.page(server.url)
        page.wait("document.body.dataset.ready === 'yes'")
        page.drop_files("#upload", [args.source / "config/tour/multisine.csv"])
        page.wait("document.querySelector('#record').value === 'multisine.csv'")
        page.choose("#model", "shipped:thesis.toml")
        page.wait("document.querySelector('.verdict.bad')")
        expect("all is well", not page.run("Boolean(document.querySelector('.trouble'))"))

        # Full while a diagnosis runs: the page says so unasked, and the answer waits.
        page.click_text("Diagnose")
        page.wait("document.querySelector('.progress')")
        fill(disk / "filler")
        page.wait("document.querySelector('.trouble')", 10)
        words = page.run("document.querySelector('.trouble').textContent")
        expect(f"what and why: {words}", str(session) in words and "No space left" in words)
        page.wait("document.querySelector('.result .words')", 120)
        result = page.run("document.querySelector('.result').innerText")
        expect(f"found and waiting: {result}", "friction" in result and "waits to be written" in result)
        expect("it is no trial yet", not page.run("Boolean(document.querySelector('.verdict .tag'))"))

        # What is changed now is refused, with one line and nothing half done.
        before = {file.name: file.read_bytes() for file in disk.iterdir() if file.name != "filler"}
        page.choose("#effect", "deadband")
        page.wait("document.querySelector('.message')")
        after = {file.name: file.read_bytes() for file in disk.iterdir() if file.name != "filler"}
        expect("the files are as before", before == after)
        if args.pictures:
            page.picture(args.pictures / "disk-full.png")

        # Room again: the diagnosis becomes the trial by itself.
        (disk / "filler").unlink()
        page.wait("!document.querySelector('.trouble')", 10)
        page.wait("document.querySelector('.verdict .tag')", 10)
        expect("its model is there", (disk / "thesis-diagnosed.toml").exists())
        expect("it no longer waits", "waits" not in page.run("document.querySelector('.result').innerText"))
        page.click_text("Accept")
        page.wait("document.querySelector('#model').value === 'thesis-diagnosed.toml'")

        # Full again: what was accepted stays, also for the next server.
        fill(disk / "filler")
        page.wait("document.querySelector('.trouble')", 10)
        page.click_text("Back one model")
        page.wait("document.querySelector('.message')")
        expect("the accepted model stays",
               page.run("document.querySelector('#model').value") == "thesis-diagnosed.toml")
        expect("and is saved", '"model": "thesis-diagnosed.toml"' in (disk / "session.json").read_text())


if __name__ == "__main__":
    sys.exit(browser_test.run(story))
