#!/usr/bin/env python3
"""Runs every `spoolwatch new` of docs/model-for-my-rig.md, and works with the file that it makes.

  check_models.py ROOT SPOOLWATCH

Each made model must be shown, simulated, and compared with the record of its own simulation, which it must
describe: the free run stays within a hundredth of the motion.
"""
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

FREE_RUN = 0.01  # of the motion's root mean square


def commands(page):
    for block in re.findall(r"^```sh\n(.*?)^```", page, re.MULTILINE | re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            words = shlex.split(line)
            if words[:2] == ["spoolwatch", "new"]:
                yield words[1:]


def run(tool, words, folder):
    done = subprocess.run([tool, *words], cwd=folder, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise SystemExit(f"spoolwatch {' '.join(words)}: exit {done.returncode}: {done.stderr}")
    return done.stdout


def main():
    root, tool = pathlib.Path(sys.argv[1]), sys.argv[2]
    kinds = set()
    for words in commands((root / "docs" / "model-for-my-rig.md").read_text()):
        kinds.add(words[1])
        with tempfile.TemporaryDirectory() as folder:
            run(tool, words, folder)
            model = words[words.index("-o") + 1]
            sheet = json.loads(run(tool, ["show", model, "--json", "-"], folder))
            if not sheet["derived"] or any(one["value"] is None for one in sheet["derived"]):
                raise SystemExit(f"{words[1]}: a derived quantity is missing: {sheet['derived']}")
            run(tool, ["simulate", model, "-o", "try.csv", "--duration", "10",
                       "--reference", "multisine"], folder)
            y = [float(line.split(",")[2]) for line in
                 (pathlib.Path(folder) / "try.csv").read_text().splitlines()[1:]]
            mean = sum(y) / len(y)
            motion = (sum((one - mean) ** 2 for one in y) / len(y)) ** 0.5
            found = json.loads(run(tool, ["compare", model, "try.csv", "--json", "-"], folder))
            if not motion > 1e-4 or not found["free_run_rms_m"] < FREE_RUN * motion:
                raise SystemExit(f"{words[1]}: moves {motion}, free run {found['free_run_rms_m']}")
    known = re.findall(r"^  ([a-z-]+): ", run(tool, ["new", "--help"], "."), re.MULTILINE)
    if kinds != set(known):
        raise SystemExit(f"the page makes {sorted(kinds)}, the program knows {sorted(known)}")


main()
