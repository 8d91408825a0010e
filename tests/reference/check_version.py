#!/usr/bin/env python3
"""One version everywhere: check_version.py ROOT BIN VERSION. Programs, and the changelog's latest release."""
import pathlib
import re
import subprocess
import sys

root, programs, version = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
for name in ("spoolwatch", "spoolwatchd", "spoolwatch-rig"):
    run = subprocess.run([programs / name, "--version"], capture_output=True, text=True)
    if run.returncode != 0 or run.stdout != f"{name} {version}\n":
        raise SystemExit(f"{name} --version: prints '{run.stdout}', exit code {run.returncode}")
released = re.search(r"^## \[(\d\S*)\] - \d{4}-\d\d-\d\d$", (root / "CHANGELOG.md").read_text(), re.M)
if released is None or released[1] != version:
    raise SystemExit(f"CHANGELOG.md: the latest release is not {version}, the project's version")
