#!/usr/bin/env python3
"""Read errors, full disks and short transfers under every program that reads or writes files.

  check_faults.py PROGRAMS CONFIG_FOLDER FAULTS_LIBRARY

A file that cannot be read whole, or becomes shorter meanwhile, is refused; transfers of seven bytes
change nothing; a file that cannot be written leaves the one that was there, and no part of another.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile


class Tries:
    def __init__(self, programs, library):
        self.programs, self.library = programs, library
        self.failures, self.tried = [], 0

    def run(self, command, fault=None, timeout_s=120):
        environment = dict(os.environ)
        if fault:
            environment.update(LD_PRELOAD=str(self.library), SPOOLWATCH_FAULT=fault)
        program, *arguments = [str(word) for word in command]
        return subprocess.run([self.programs / program, *arguments], env=environment, text=True,
                              capture_output=True, timeout=timeout_s)

    def check(self, name, condition, result):
        self.tried += 1
        if not condition:
            self.failures.append(f"{name}: exit {result.returncode}: "
                                 f"{(result.stderr + result.stdout)[-300:]}")

    def reads(self, command, file, exit_code):
        """A file that the command reads."""
        size = file.stat().st_size
        good = self.run(command)
        self.check(f"{file.name} as it is", good.returncode == 0, good)
        for at in sorted({0, 1, size // 3, size // 2, size - 1}):
            bad = self.run(command, f"read_eio:{file.name}:{at}")
            line = (bad.stderr or bad.stdout).strip().splitlines()
            self.check(f"{file.name}: EIO at byte {at} of {size}",
                       bad.returncode == exit_code and len(line) == 1 and file.name in line[0]
                       and "Input/output error" in line[0], bad)
        short = self.run(command, f"read_short:{file.name}:0")
        self.check(f"{file.name}: seven bytes at a time",
                   short.returncode == 0 and short.stdout == good.stdout, short)

    def shrinks(self, command, file):
        """A record that is cut off while the command reads it."""
        whole = file.read_bytes()
        line_end = whole.index(b"\n", len(whole) // 2) + 1
        for at in (len(whole) // 3, line_end, len(whole) - 1):
            bad = self.run(command, f"read_shrunk:{file.name}:{at}")
            self.check(f"{file.name}: cut off at byte {at} while it is read",
                       bad.returncode == 65 and "became shorter" in bad.stderr
                       and file.stat().st_size == at, bad)
            file.write_bytes(whole)

    def writes(self, command, file):
        """A file that the command writes, over one that is there."""
        good = self.run(command)
        self.check(f"{file.name} written", good.returncode == 0, good)
        whole = file.read_bytes()
        for kind in ("write_enospc", "write_eio"):
            for at in sorted({0, 1, len(whole) // 2, len(whole) - 1}):
                file.write_bytes(b"what was there")
                bad = self.run(command, f"{kind}:{file.name}:{at}")
                left = [p.name for p in file.parent.iterdir()
                        if p.name.startswith(file.name) and p != file]
                self.check(f"{file.name}: {kind} at byte {at}",
                           bad.returncode == 1 and file.read_bytes() == b"what was there"
                           and not left, bad)
        short = self.run(command, f"write_short:{file.name}:0")
        self.check(f"{file.name}: seven bytes at a time",
                   short.returncode == 0 and file.read_bytes() == whole, short)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("config", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    options = parser.parse_args()
    tries = Tries(options.programs.resolve(), options.library.resolve())
    with tempfile.TemporaryDirectory(prefix="spoolwatch-faults-") as name:
        folder = pathlib.Path(name)
        subprocess.run(["cp", "-r", f"{options.config}/.", name], check=True)
        thesis = folder / "models/thesis.toml"
        settings = [word for table in ("control.socket", "alarms.folder", "evidence.folder",
                                       "recorder.folder") for word in ("--set", f"{table}=")]
        tries.reads(["spoolwatchd", "--config", folder / "spoolwatchd.toml", "--lcm-url", "",
                     *settings, "--check"], folder / "spoolwatchd.toml", 78)
        record = folder / "steps.csv"
        record.write_bytes((folder / "tour/steps.csv").read_bytes())
        estimate = ["spoolwatch", "estimate", record, "--structure", "arx111"]
        tries.reads(["spoolwatch", "add", thesis, "friction", "coulomb_N=20", "-o",
                     "/dev/stdout"], thesis, 78)
        tries.run(["spoolwatch", "export", record, "-o", folder / "r.mat"])
        logs = folder / "logs"
        made = tries.run(["spoolwatchd", "--config", folder / "thesis_case1.toml", "--clock",
                          "virtual", "--duration", "8", "--lcm-url", "", "--set",
                          f"recorder.folder={logs}", "--set", "evidence.folder="])
        tries.check("a log", made.returncode == 0, made)
        tries.reads(estimate, record, 65)
        tries.shrinks(estimate, record)
        mat = folder / "r.mat"
        tries.reads(["spoolwatch", "estimate", mat, "--structure", "arx111"], mat, 65)
        tries.writes(["spoolwatch", "add", thesis, "friction", "coulomb_N=20", "-o",
                      folder / "better.toml"], folder / "better.toml")
        tries.writes(["spoolwatch", "export", record, "-o", folder / "out.mat"], folder / "out.mat")
        tries.writes(["spoolwatch", "export", record, "-o", folder / "out.csv"], folder / "out.csv")
        tries.writes(["spoolwatch", "simulate", thesis, "-o", folder / "sim.csv", "--duration", "5"],
                     folder / "sim.csv")
        # The daemon goes on, and says at its end what is not in the log.
        for kind in ("write_enospc", "write_eio"):
            bad = tries.run(["spoolwatchd", "--config", folder / "thesis_case1.toml", "--clock",
                             "virtual", "--duration", "5", "--lcm-url", "", "--set",
                             f"recorder.folder={folder}/log-{kind}", "--set", "evidence.folder="],
                            f"{kind}:log-{kind}:30000")
            tries.check(f"recorder: {kind}",
                        bad.returncode == 1 and "messages are not in the log" in bad.stderr, bad)
    print(f"{tries.tried} tries")
    print(*tries.failures, sep="\n")
    sys.exit(1 if tries.failures else 0)


if __name__ == "__main__":
    main()
