#!/usr/bin/env python3
"""Runs the examples: run.py ROOT BIN EXAMPLE, EXAMPLE: alarms CXX_PROGRAM, or own_effect.

alarms: both subscribers read the same log and must print the same changes. own_effect: the formula acts.
"""
import os
import pathlib
import subprocess
import sys
import tempfile


def run(*words, cwd, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, cwd=cwd, **more)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def alarms(root, programs, out, subscriber):
    run(programs / "spoolwatchd", "--config", root / "config/demo.toml", "--clock", "virtual", "--duration", "30",
        "--lcm-url", "", "--set", f"recorder.folder={out}", "--set", f"evidence.folder={out}/evidence",
        "--set", f"alarms.folder={out}", "--set", "control.socket=", cwd=out)
    url = f"file://{next(out.glob('*.lcmlog'))}?mode=r&speed=0"
    path = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
    compiled = run(subscriber, url, cwd=out).splitlines()
    script = run(root / "examples/alarm_subscriber.py", url, cwd=out, env=path).splitlines()
    changes = [[line.split(" = ")[0] for line in lines] for lines in (compiled, script)]
    if not any(line.startswith("MAJOR") for line in compiled) or changes[0] != changes[1]:
        raise SystemExit("\n".join(["C++:", *compiled, "Python:", *script]))


def own_effect(root, programs, out):
    model = root / "examples/own_effect/end_cushion.toml"
    if "end_cushion" not in run(programs / "spoolwatch", "effects", model, cwd=out):
        raise SystemExit("`spoolwatch effects` does not list the effect")
    simulate = [programs / "spoolwatch", "simulate", model, "--duration", "2", "--reference", "sine", "-o"]
    run(*simulate, "with.csv", cwd=out)
    run(*simulate, "without.csv", "--set", "effects.end_cushion.throttle_N_s2_per_m2=0", cwd=out)
    if (out / "with.csv").read_bytes() == (out / "without.csv").read_bytes():
        raise SystemExit("the effect changes nothing")


root, programs = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:
    {"alarms": alarms, "own_effect": own_effect}[sys.argv[3]](root, programs, pathlib.Path(folder), *sys.argv[4:])
