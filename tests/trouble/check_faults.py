#!/usr/bin/env python3
"""Read errors, full disks and short transfers under every program that reads or writes files.

  check_faults.py PROGRAMS CONFIG_FOLDER FAULTS_LIBRARY

A file that cannot be read whole, or becomes shorter meanwhile, is refused; transfers of seven bytes
change nothing; a file that cannot be written leaves the one that was there, and no part of another.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from stand import Daemon  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]


def timeless(text):
    """Without the minute at which a report was made, and the time that the answer took."""
    return re.sub(rb"20\d\d-\d\d-\d\d \d\d:\d\d|\"(?:runtime|fit)_s\": *[-+.e0-9]+", b"", text)


class Tries:
    def __init__(self, programs, library):
        self.programs, self.library = programs, library
        self.failures, self.tried, self.faults = [], 0, 0

    def run(self, command, fault=None, timeout_s=120):
        environment = dict(os.environ)
        if fault:
            self.faults += 1
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

    def makes(self, command, file):
        """A file that the command writes where none is: all of it or nothing."""
        good = self.run(command)
        self.check(f"{file.name} written", good.returncode == 0, good)
        whole = file.read_bytes()
        for fault in (*(f"{kind}:{file.name}:{at}" for kind in ("write_enospc", "write_eio")
                        for at in (0, len(whole) // 2)), f"sync_eio:{file.name}:0",
                      f"rename_eio:{file.name}:0"):
            file.unlink()
            bad = self.run(command, fault)
            left = [p for p in file.parent.iterdir() if p.name.startswith(file.name)]
            self.check(f"{file.name}: {fault}", bad.returncode == 1 and not left, bad)
            file.touch()
        file.unlink()
        short = self.run(command, f"write_short:{file.name}:0")
        self.check(f"{file.name}: seven bytes at a time",
                   short.returncode == 0 and file.read_bytes() == whole, short)

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
        for kind in ("sync_eio", "rename_eio"):
            file.write_bytes(b"what was there")
            bad = self.run(command, f"{kind}:{file.name}:0")
            left = [p for p in file.parent.iterdir() if p.name.startswith(file.name) and p != file]
            self.check(f"{file.name}: {kind}, cannot take its place",
                       bad.returncode == 1 and file.read_bytes() == b"what was there" and not left, bad)
        # The name is not on the disk: the file is there, and the command says so.
        bad = self.run(command, f"sync_folder_eio:{file.parent.name}:0")
        self.check(f"{file.name}: its folder is not synced",
                   bad.returncode == 1 and timeless(file.read_bytes()) == timeless(whole)
                   and "Input/output error" in bad.stderr, bad)
        short = self.run(command, f"write_short:{file.name}:0")
        self.check(f"{file.name}: seven bytes at a time",
                   short.returncode == 0 and timeless(file.read_bytes()) == timeless(whole), short)

    def grows(self, command, file):
        """A record that is written row by row: it has its name when it is whole, and what came before a fault
        stays beside it."""
        good = self.run(command)
        self.check(f"{file.name} written", good.returncode == 0, good)
        whole = file.read_bytes()
        part = file.with_name(file.name + ".part")
        for fault in (f"write_enospc:{file.name}:0", f"write_enospc:{file.name}:{len(whole) // 2}",
                      f"write_eio:{file.name}:{len(whole) - 1}", f"sync_eio:{file.name}:0",
                      f"rename_eio:{file.name}:0"):
            file.write_bytes(b"what was there")
            bad = self.run(command, fault)
            left = part.read_bytes()
            said = [line for line in bad.stderr.splitlines() if "cannot be written" in line]
            self.check(f"{file.name}: {fault}",
                       bad.returncode == 1 and file.read_bytes() == b"what was there" and len(said) == 1
                       and part.name in said[0] and whole.startswith(left) and (not left or left.endswith(b"\n")), bad)
            part.unlink()
        bad = self.run(command, f"sync_folder_eio:{file.parent.name}:0")
        self.check(f"{file.name}: its folder is not synced",
                   bad.returncode == 1 and file.read_bytes() == whole and "Input/output error" in bad.stderr, bad)
        short = self.run(command, f"write_short:{file.name}:0")
        self.check(f"{file.name}: seven bytes at a time",
                   short.returncode == 0 and file.read_bytes() == whole and not part.exists(), short)

    def promotes(self, config):
        """Model and bands of the running daemon, which are replaced and brought back together."""
        healthy, own = config / "healthy.csv", config / "promoted"
        own.mkdir()
        subprocess.run(["cp", "-r", config / "models", config / "live_loop.toml", own], check=True)
        with Daemon(self.programs, own / "live_loop.toml", ["loop.privileges=try"]) as daemon:
            ask = ("--socket", daemon.socket)
            files = [own / "models/thesis.toml", own / "live_bands.toml"]
            forth = ["spoolwatch", "promote", own / "models/thesis_calibrated.toml", "--record", healthy, *ask]
            back = ["spoolwatch", "promote", "--back", *ask]
            first = self.run(forth)
            self.check("promoted", first.returncode == 0, first)
            answer = own / "status.json"
            for fault in ("write_enospc", "write_eio", "rename_eio"):
                answer.write_bytes(b"what was there")
                bad = self.run(["spoolwatch", "status", "--json", answer, *ask], f"{fault}:{answer.name}:0")
                self.check(f"{answer.name}: {fault}", bad.returncode == 1 and len(bad.stderr.splitlines()) == 1
                           and answer.read_bytes() == b"what was there", bad)
            for command in (back, forth):
                before = [file.read_bytes() for file in files]
                for fault in (*(f"{kind}:{file.name}:0" for file in files
                                for kind in ("write_enospc", "write_eio", "sync_eio", "rename_eio")),
                              *(f"sync_folder_eio:{file.parent.name}:0" for file in files)):
                    bad = self.run(command, fault)
                    now = [file.read_bytes() for file in files]
                    line = bad.stderr.strip().splitlines()
                    self.check(f"{command[2]}: {fault}",
                               bad.returncode == 1 and now == before and len(line) == 1
                               and not any(".part" in p.name for file in files for p in file.parent.iterdir()), bad)
                good = self.run(command)
                self.check(f"{command[2]} after all", good.returncode == 0, good)

    def alarms(self, config, fault, alarm):
        """Files of the running daemon: it goes on, and an alarm says what is missing."""
        self.tried += 1
        self.faults += 1
        with Daemon(self.programs, config, ["loop.privileges=try"],
                    environment={"LD_PRELOAD": str(self.library), "SPOOLWATCH_FAULT": fault}) as daemon:
            obeys = daemon.ask("stop")["ok"] and daemon.ask("start")["ok"]
            ends = time.monotonic() + 15
            names = set()
            while alarm not in names and time.monotonic() < ends:
                time.sleep(0.2)
                names = {f"{a['source']}.{a['name']}" for a in daemon.ask("alarms")["alarms"] if a["life"] != "NORMAL"}
            daemon.end()
            if not obeys or alarm not in names or daemon.process.returncode != 0:
                self.failures.append(f"{fault}: exit {daemon.process.returncode}, alarms {sorted(names)}")


# A reading that is missing from the first second on raises an alarm, which the daemon saves.
TROUBLED = """
[[guard]]
kind = "transducer"
channel = "pressure_in"
action = "indicate"
[[sim.trouble]]
kind = "missing"
pressure = "pressure_in"
from_s = 1.0
to_s = 1000.0
"""


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
        calibrated = folder / "models/thesis_calibrated.toml"
        healthy = folder / "healthy.csv"
        tries.writes(["spoolwatch", "simulate", calibrated, "-o", healthy, "--duration", "60"], healthy)
        bands = folder / "bands.toml"
        tries.writes(["spoolwatch", "calibrate", folder / "demo.toml", healthy, "-o", bands], bands)
        with_bands = folder / "with_bands.toml"
        with_bands.write_text((folder / "demo.toml").read_text().replace(
            "schema_version = 1", 'schema_version = 1\nbands_file = "bands.toml"', 1))
        tries.reads(["spoolwatchd", "--config", with_bands, "--lcm-url", "", *settings, "--check"], bands, 78)
        learned = folder / "learned.toml"
        tries.writes(["spoolwatch", "isolate", calibrated, healthy, "--learn", learned], learned)
        with_healthy = folder / "with_healthy.toml"
        with_healthy.write_text((folder / "thesis_case3_named.toml").read_text().replace(
            "learn_s = 8.0", 'healthy = "learned.toml" #', 1))
        tries.reads(["spoolwatchd", "--config", with_healthy, "--lcm-url", "", *settings, "--check"], learned, 78)
        trained = folder / "trained.toml"
        tries.writes(["spoolwatch", "train", folder / "scorecard/cusum.toml", "--healthy", healthy, "-o", trained],
                     trained)
        mapping = folder / "columns.map"
        tries.writes(["spoolwatch", "import", record, "--save-map", mapping], mapping)
        tries.reads([*estimate, "--map", mapping], mapping, 78)
        tries.writes(["spoolwatch", "import", record, "-o", folder / "clean.csv"], folder / "clean.csv")
        tries.writes(["spoolwatch", "fit", thesis, record, "-o", folder / "fitted.toml"], folder / "fitted.toml")
        tries.writes(["spoolwatch", "diagnose", thesis, record, "--quiet", "--only", "friction", "-o",
                      folder / "diagnosed.toml"], folder / "diagnosed.toml")
        tries.writes(["spoolwatch", "isolate", calibrated, healthy, "--json", folder / "isolated.json"],
                     folder / "isolated.json")
        for option, name in (("--json", "compared.json"), ("--report", "compared.html"),
                             ("--residuals", "compared.csv")):
            tries.writes(["spoolwatch", "compare", thesis, record, option, folder / name], folder / name)
        log = next(logs.iterdir())
        for name in ("out.mcap", "out.json"):
            tries.writes(["spoolwatch", "export", log, "-o", folder / name], folder / name)
        tries.reads(["spoolwatch", "export", log, "-o", folder / "log.csv"], log, 65)
        tries.grows(["spoolwatch", "record", "-o", folder / "recorded.csv", "--lcm-url",
                     f"file://{log}?mode=r&speed=0"], folder / "recorded.csv")
        tries.promotes(folder)
        tries.makes(["spoolwatch", "new", "stand", "--backend", "sim", "--model", calibrated, "--low-mm", "0",
                     "--high-mm", "600", "--max-speed-mmps", "500", "-o", folder / "stand.toml"],
                     folder / "stand.toml")
        tries.makes(["spoolwatch", "new", "screw-axis", "--mass-kg", "30", "--lead-mm", "10", "--inertia-kgcm2",
                      "2", "--torque-constant-Nm-per-A", "0.5", "--drive-A-per-V", "1", "-o",
                      folder / "axis.toml"], folder / "axis.toml")
        evidence = folder / "evidence"
        alarmed = ["spoolwatchd", "--config", folder / "thesis_case1.toml", "--clock", "virtual", "--duration",
                   "30", "--lcm-url", "", "--set", "recorder.folder=", "--set", f"evidence.folder={evidence}"]
        made = tries.run(alarmed)
        tries.check("evidence", made.returncode == 0, made)
        pack = sorted(evidence.iterdir())[0]
        for file in sorted(pack.iterdir()):
            if file.name in ("log.lcmlog", "pack.json", "pipeline.toml", "state.bin"):
                tries.reads(["spoolwatch", "replay", pack], file, 65)
        # An alarm without its evidence is said; the daemon goes on.
        for fault in ("write_enospc:/evidence/:0", "write_eio:log.lcmlog:5000", "write_enospc:pack.json:0",
                      "sync_eio:/evidence/:0", "rename_eio:/evidence/:0"):
            subprocess.run(["rm", "-r", evidence], check=True)
            bad = tries.run(alarmed, fault)
            tries.check(f"evidence: {fault}", bad.returncode == 0 and not any(evidence.iterdir()), bad)
        calibration = folder / "calibration.toml"
        tries.writes(["spoolwatchd", "--config", folder / "spoolwatchd.toml", "--commission", calibration, "--yes",
                      "--clock", "virtual"], calibration)
        setpoints = folder / "setpoints.csv"
        setpoints.write_text("t_s,reference_m\n0,0.3\n10,0.31\n20,0.3\n")
        with_setpoints = folder / "with_setpoints.toml"
        with_setpoints.write_text(re.sub(r"\[reference\].*?\n\n", '[reference]\nkind = "file"\nfile = '
                                         '"setpoints.csv"\n\n', (folder / "demo.toml").read_text(), flags=re.S))
        tries.reads(["spoolwatchd", "--config", with_setpoints, "--lcm-url", "", *settings, "--check"], setpoints, 78)
        troubled = folder / "troubled.toml"
        troubled.write_text((folder / "pressures.toml").read_text() + TROUBLED)
        for fault, alarm in (("write_enospc:alarms.json:0", "not_saved"), ("write_eio:alarms.json:100", "not_saved"),
                             ("sync_eio:alarms.json:0", "not_saved"), ("rename_eio:alarms.json:0", "not_saved"),
                             ("write_enospc:history.log:0", "history_not_saved"),
                             ("sync_eio:history.log:0", "history_not_saved"),
                             ("write_eio:audit.log:0", "audit_lost"), ("sync_eio:audit.log:0", "audit_lost")):
            tries.alarms(troubled, fault, f"alarms.{alarm}")
        # The daemon goes on, and says at its end what is not in the log.
        for kind in ("write_enospc", "write_eio"):
            bad = tries.run(["spoolwatchd", "--config", folder / "thesis_case1.toml", "--clock",
                             "virtual", "--duration", "5", "--lcm-url", "", "--set",
                             f"recorder.folder={folder}/log-{kind}", "--set", "evidence.folder="],
                            f"{kind}:log-{kind}:30000")
            tries.check(f"recorder: {kind}",
                        bad.returncode == 1 and "messages are not in the log" in bad.stderr, bad)
    print(f"{tries.tried} tries, {tries.faults} with a fault")
    said = re.search(r"(\d+) faults of reading", (ROOT / "docs/developing.md").read_text())
    if not said or int(said[1]) != tries.faults:
        tries.failures.append(f"docs/developing.md counts {said[1] if said else 'no'} faults")
    print(*tries.failures, sep="\n")
    sys.exit(1 if tries.failures else 0)


if __name__ == "__main__":
    main()
