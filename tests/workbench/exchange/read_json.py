"""Reads exported lines of JSON: read_json.py F.json"""
import json
import sys


def refuse(word):
    raise ValueError(word + " is no JSON")


with open(sys.argv[1]) as file:
    lines = [json.loads(line, parse_constant=refuse) for line in file]
assert all(isinstance(line["timestamp"], float) for line in lines)
samples = [line["sample"] for line in lines if "sample" in line]
assert len(samples) == 20 and samples[10]["y_m"] == 0.1 + 1e-3 * 10
assert samples[0]["reference_m"] is None
estimates = [line["estimate"]["period"] for line in lines if "estimate" in line]
assert estimates[0]["b1"]["value"] == 2e-4 and estimates[0]["b1"]["high"] is None
alarms = [line["alarm"]["period"]["b1_low"] for line in lines if "alarm" in line]
assert [alarm["active"] for alarm in alarms] == [True, False]
print("good")
