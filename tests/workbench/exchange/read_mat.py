"""Reads what spoolwatch exported, by SciPy and by the csv module: read_mat.py F.mat F.csv"""
import csv
import sys

try:
    import scipy.io
except ImportError:
    sys.exit(77)

mat = scipy.io.loadmat(sys.argv[1], simplify_cells=True)
with open(sys.argv[2]) as file:
    rows = list(csv.DictReader(file))
assert len(rows) == len(mat["t_s"]) == 20, len(mat["t_s"])
for name in ("t_s", "u_V", "y_m", "reference_m", "quality"):
    for row, number in zip(rows, mat[name]):  # the same double, or missing in both
        same = float(row[name]) == number if row[name] else number != number
        assert same, (name, row[name], number)
period = mat["estimates"]["period"]
assert list(period["t_s"]) == [0.5, 0.505], period["t_s"]
assert list(period["valid"]) == [1, 0]
assert list(period["b1"]["value"]) == [2e-4, 3e-4]
assert period["b1"]["low"][0] == 1.9e-4
assert period["a1"]["value"][1] != period["a1"]["value"][1], "missing is NaN"
alarms = mat["alarms"]
assert [a["active"] for a in alarms] == [1, 0]
assert alarms[0]["name"] == "b1_low" and alarms[0]["severity"] == "MAJOR"
assert alarms[0]["reason"] == "b1 is low, 20 ?C" and len(alarms[1]["reason"]) == 0
assert alarms[0]["value"] == 1.5e-4 and alarms[0]["t_s"] == 0.505
print("good")
