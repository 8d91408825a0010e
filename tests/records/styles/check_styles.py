#!/usr/bin/env python3
"""Every file of make_styles.py is read with the right numbers, or refused in one line with exit 65.

Usage: check_styles.py FOLDER SPOOLWATCH [NAME...]"""
import csv
import glob
import io
import json
import os
import subprocess
import sys


def differences(truth, run):
    """What is wrong, as lines of text."""
    if "refused" in truth:
        lines = run.stderr.strip().split("\n")
        wrong = [] if run.returncode == 65 else [f"exit {run.returncode}, not 65"]
        if len(lines) != 1:
            wrong.append(f"{len(lines)} lines of message")
        wrong += [f"no '{word}' in: {run.stderr.strip()}" for word in truth["refused"] if word not in run.stderr]
        return wrong
    if run.returncode != 0:
        return [f"exit {run.returncode}: {run.stderr.strip()}"]
    table = list(csv.reader(io.StringIO(run.stdout)))
    header = table[0]
    found = {name: [float(row[k]) if row[k] else None for row in table[1:]]
             for k, name in enumerate(header)}
    wanted = {"t_s": truth["t_s"], "u_" + truth["command_unit"]: truth["u"],
              "y_" + truth["position_unit"]: truth["y"], **truth["further"]}
    wrong = []
    for name, values in wanted.items():
        if name not in found:
            wrong.append(f"no column {name} among {header}")
            continue
        if len(found[name]) != len(values):
            wrong.append(f"{name}: {len(found[name])} values, not {len(values)}")
            continue
        offset = found["t_s"][0] - values[0] if name == "t_s" and abs(values[0]) < 1e6 else 0.0
        size = max(abs(value) for value in values) if name != "t_s" else 1.0
        for k, (a, b) in enumerate(zip(found[name], values)):
            if a is None or not abs(a - offset - b) <= truth["tolerance"] * max(size, 1e-9):
                wrong.append(f"{name}[{k}] is {a}, not {b}")
                break
    return wrong


def main(folder, program, names):
    count = failed = 0
    for file in sorted(glob.glob(os.path.join(folder, "*.truth.json"))):
        name = os.path.basename(file)[: -len(".truth.json")]
        if names and name not in names:
            continue
        with open(file) as text:
            truth = json.load(text)
        arguments = [word.replace("FOLDER", folder) for word in truth["arguments"]]
        record = os.path.join(folder, truth["file"])
        run = subprocess.run([program, "import", record, *arguments, "-o", "-"], capture_output=True,
                             text=True, errors="replace", timeout=60)
        wrong = differences(truth, run)
        count += 1
        failed += bool(wrong)
        for line in wrong:
            print(f"{name}: {line}")
    print(f"{count - failed} of {count} files as they should be")
    return 1 if failed or count == 0 else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], sys.argv[3:]))
