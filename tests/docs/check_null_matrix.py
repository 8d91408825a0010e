#!/usr/bin/env python3
"""Whether the tables of docs/safety.md are those of today's programs, and what docs/developing.md counts.

  check_null_matrix.py PROGRAMS DAEMON_TEST

Each trouble has a row, in order, with what `spoolwatchd --check` states now; on the simulated rig, in virtual
time, the measured times are the page's to the digit. No measurement is worse than stated. `scripts/null-matrix
--update` brings the tables up to date.
"""
import importlib.machinery
import importlib.util
import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "trouble"))
import check_flood  # noqa: E402
import measure_null  # noqa: E402
import modbus_troubles  # noqa: E402

NUMBERS = {"six": 6, "seventeen": 17, "sixty": 60}


def null_matrix():
    """scripts/null-matrix as a module."""
    loader = importlib.machinery.SourceFileLoader("null_matrix", str(ROOT / "scripts" / "null-matrix"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("null_matrix", loader))
    loader.exec_module(module)
    return module


def rows_of(page, name):
    """The cells of each row of a table."""
    text = page.partition(f"<!-- scripts/null-matrix: {name} -->\n")[2]
    text = text.partition(f"<!-- scripts/null-matrix: end of {name} -->")[0]
    return [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in text.splitlines()[2:]]


def late(stated, measured):
    """Whether the lower end is beyond what is stated."""
    return float(measured.split()[0]) > float(stated)


def stated_today(programs, action, on_tcp):
    """What --check states for the configuration of measure_null.py, without a device."""
    text = (ROOT / "config" / "bench_modbus.toml").read_text()
    if not on_tcp:
        text = text.replace('address = "127.0.0.1:1502"', 'serial = "/nowhere"\nbaud = 115200\nparity = "none"')
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "bench.toml")
        file.write_text(text + measure_null.GUARDS.format(action))
        return measure_null.stated(programs, file, measure_null.SETTINGS)


def check_troubles(page, name, troubles, in_time, stated):
    wrong = []
    rows = rows_of(page, name)
    if [row[0] for row in rows] != list(troubles):
        missing = set(troubles) ^ {row[0] for row in rows}
        return [f"{name}: other rows than tests/trouble has troubles: {', '.join(sorted(missing)) or 'their order'}"]
    for trouble, row, time, measured, _ in rows:
        wanted = ("-", "-") if trouble in in_time else (measure_null.row_of(trouble), None)
        if row != wanted[0]:
            wrong.append(f"{name}: {trouble}: row {row}, {wanted[0]} in measure_null.py")
        elif row != "-" and abs(stated.get(row, 0.0) * 1e3 - float(time)) > 0.051:
            wrong.append(f"{name}: {trouble}: stated {time}, --check: {stated.get(row, 0.0) * 1e3:.1f} ms")
        elif row != "-" and late(time, measured):
            wrong.append(f"{name}: {trouble}: {measured}, stated {time}")
    return wrong


def check_failures(page, daemon_test):
    """The simulated rig's columns are measured again; of the others no time may be worse than stated."""
    module = null_matrix()
    matrix = module.Matrix()
    matrix.simulated(daemon_test)
    today = {}
    for line in matrix.table().splitlines()[2:]:
        cells = [cell.strip() for cell in line.strip("| ").split(" | ")]
        today[tuple(cells[:2])] = cells[2:4]
    wrong, seen = [], set()
    for failure, action, *times in rows_of(page, "failures"):
        seen.add((failure, action))
        measured = today.get((failure, action))
        if times[0] != "-" and measured != times[:2]:
            wrong.append(f"failures: {failure}, {action}: {times[:2]}, today {measured}")
        wrong += [f"failures: {failure}, {action}: {times[i + 1]}, stated {times[i]}"
                  for i in (0, 2) if times[i] != "-" and late(times[i], times[i + 1])]
    wrong += [f"failures: lacks {row}" for row in today if row not in seen]
    return wrong if matrix.as_stated else [*wrong, "failures: a time is worse than stated"]


def check_counts(text):
    """What docs/developing.md says of tests/trouble."""
    kinds = len(modbus_troubles.TROUBLES) + len(modbus_troubles.ON_ACCEPT) + 1  # half open
    runs = 2 * len(modbus_troubles.TROUBLES) + len(modbus_troubles.ON_ACCEPT) + 1
    on_rtu = len(modbus_troubles.ON_RTU)
    said = re.search(r"(\w+) kinds of Modbus trouble over TCP \((\d+) runs\) and (\d+) on a serial line "
                     r"\((\d+) runs\), (\w+) floods", text)
    if not said:
        return ["docs/developing.md: counts no troubles"]
    found = [NUMBERS.get(word) or int(word) for word in said.groups()]
    wanted = [kinds, runs, on_rtu, 2 * on_rtu, len(check_flood.FLOODS)]
    return [] if found == wanted else [f"docs/developing.md: counts {found}, tests/trouble has {wanted}"]


def main():
    programs, daemon_test = (pathlib.Path(word) for word in sys.argv[1:])
    page = (ROOT / "docs" / "safety.md").read_text()
    wrong = check_counts((ROOT / "docs" / "developing.md").read_text())
    wrong += check_failures(page, daemon_test)
    for name, troubles, in_time, action, on_tcp in (
            ("troubles", modbus_troubles.TROUBLES, measure_null.IN_TIME, "latch", True),
            ("ramp", modbus_troubles.TROUBLES, measure_null.IN_TIME, "ramp", True),
            ("serial", modbus_troubles.ON_RTU, measure_null.IN_TIME_ON_RTU, "latch", False)):
        wrong += check_troubles(page, name, troubles, in_time, stated_today(programs, action, on_tcp))
    for failure, action, stated, measured in rows_of(page, "board"):
        if re.match(r"[0-9.]+$", stated) and late(stated, measured):
            wrong.append(f"board: {failure}, {action}: {measured}, stated {stated}")
    print(*wrong, sep="\n")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
