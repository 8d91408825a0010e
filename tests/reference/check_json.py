#!/usr/bin/env python3
"""Holds the output of --json against the schemas in docs/reference/schema.

  check_json.py ROOT BIN NAME     runs the command and validates what it writes; NAME: compare, ...
  check_json.py --planted         does the validation find faults that are planted?

The part of JSON Schema that the files use: type, enum, required, properties, additionalProperties, items,
oneOf, $ref to $defs. Any other keyword is refused.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

KNOWN = {"$schema", "title", "description", "$defs", "$ref", "type", "enum", "required", "properties",
         "additionalProperties", "items", "oneOf"}
TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}


def is_a(value, name):
    if name == "number":
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    if name == "integer":
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, TYPES[name])


def faults(value, schema, root, path="$"):
    """One line for each place where `value` is not what the schema says."""
    unknown = set(schema) - KNOWN
    if unknown:
        return [f"{path}: the schema has keywords that are not checked: {sorted(unknown)}"]
    if "$ref" in schema:
        return faults(value, root["$defs"][schema["$ref"].rsplit("/", 1)[1]], root, path)
    if "oneOf" in schema:
        fitting = [one for one in schema["oneOf"] if not faults(value, one, root, path)]
        return [] if len(fitting) == 1 else [f"{path}: fits {len(fitting)} of the alternatives, not one"]
    types = schema.get("type", [])
    types = [types] if isinstance(types, str) else types
    if types and not any(is_a(value, one) for one in types):
        return [f"{path}: is {json.dumps(value)[:60]}; allowed: {' or '.join(types)}"]
    if "enum" in schema and value not in schema["enum"]:
        return [f"{path}: is {json.dumps(value)}; allowed: {schema['enum']}"]
    found = []
    if isinstance(value, list) and "items" in schema:
        for i, one in enumerate(value):
            found += faults(one, schema["items"], root, f"{path}[{i}]")
    if isinstance(value, dict):
        found += [f"{path}: lacks {key}" for key in schema.get("required", []) if key not in value]
        declared, other = schema.get("properties", {}), schema.get("additionalProperties", True)
        for key, one in value.items():
            if key in declared:
                found += faults(one, declared[key], root, f"{path}.{key}")
            elif isinstance(other, dict):
                found += faults(one, other, root, f"{path}.{key}")
            elif other is False:
                found.append(f"{path}.{key}: is not in the schema")
    return found


def commands(root, out):
    """{schema: [commands, the last of which prints the JSON]}."""
    models, tour = root / "config/models", root / "config/tour"
    servo = ["spoolwatch", "simulate", models / "velocity_servo.toml", "-o", out / "servo.csv", "--duration", "20",
             "--seed", "3", "--set", "instruments.noise_m=2e-6", "--set", "instruments.encoder_resolution_m=5e-6"]
    changed = [*servo, "--reference", "multisine", "--fault", "gain_mps_per_V*1.3@14"]
    model, record = models / "velocity_servo.toml", out / "servo.csv"
    return {
        "effects": [["spoolwatch", "effects", models / "cubic_drag.toml", "--json", "-"]],
        "compare": [["spoolwatch", "compare", models / "thesis.toml", tour / "multisine.csv", "--json", "-"]],
        "estimate": [servo, ["spoolwatch", "estimate", record, "--method", "sliding", "--window", "5",
                             "--stride", "5", "--json", "-"]],
        "import": [servo, ["spoolwatch", "import", record, "--json", "-"]],
        "select": [servo, ["spoolwatch", "select", record, "--structures", "arx111,arx211,oe111", "--quiet",
                           "--json", "-"]],
        "fit": [servo, ["spoolwatch", "fit", model, record, "--starts", "2", "--profile", "gain_mps_per_V", "--quiet",
                        "--json", "-"]],
        "diagnose": [[*servo, "--set", "effects.deadband.half_width_V=0.05"],
                     ["spoolwatch", "diagnose", model, record, "--quiet", "--json", "-"]],
        "isolate": [changed, ["spoolwatch", "isolate", model, record, "--parameters", "gain_mps_per_V",
                              "--json", "-"]],
        "scorecard": [["spoolwatch", "scorecard", "thesis_thresholds", "--seeds", "1", "--hours", "0.01", "--motion",
                       "sine", "--fault", "supply_pressure", "--json", "-"]],
        "reproduce": [["spoolwatch", "reproduce", "--json", "-"]],
        "listen": [["spoolwatchd", "--config", root / "config/demo.toml", "--clock", "virtual", "--duration", "20",
                    "--lcm-url", "", "--set", f"recorder.folder={out}", "--set", f"evidence.folder={out}/evidence",
                    "--set", f"alarms.folder={out}", "--set", "control.socket="],
                   ["spoolwatch", "listen", "--json", "--lcm-url", "LOG"]],
    }


def check(root, programs, name):
    schema = json.loads((root / f"docs/reference/schema/{name}.schema.json").read_text())
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        for words in commands(root, out)[name]:
            if "LOG" in words:
                log = next(iter(sorted(out.glob("*.lcmlog"))), "none")
                words = [f"file://{log}?mode=r&speed=0" if word == "LOG" else word for word in words]
            run = subprocess.run([str(programs / words[0]), *map(str, words[1:])], capture_output=True, text=True,
                                 cwd=folder)
            if run.returncode != 0:
                raise SystemExit(f"{' '.join(map(str, words))}: exit code {run.returncode}\n{run.stderr}")
    documents = [json.loads(run.stdout)] if name != "listen" else [json.loads(line) for line in
                                                                   run.stdout.splitlines()]
    found = {line for document in documents for line in faults(document, schema, schema)}
    if name == "listen":
        missing = {"run", "alarm", "estimate", "health"} - {document["type"] for document in documents}
        found |= {f"no line of type {one}" for one in missing}
    if found:
        raise SystemExit("\n".join(sorted(found)[:20]) + f"\nagainst docs/reference/schema/{name}.schema.json")


def planted():
    schema = {"type": "object", "required": ["a"], "additionalProperties": False,
              "properties": {"a": {"type": ["number", "null"]}, "b": {"type": "string", "enum": ["x"]},
                             "c": {"type": "array", "items": {"$ref": "#/$defs/n"}}},
              "$defs": {"n": {"type": "integer"}}}
    for good in ({"a": 1.5}, {"a": None, "b": "x", "c": [1, 2]}):
        assert not faults(good, schema, schema), good
    for bad in ({}, {"a": "1"}, {"a": True}, {"a": 1, "b": "y"}, {"a": 1, "c": [1, 2.5]}, {"a": 1, "d": 0}):
        assert len(faults(bad, schema, schema)) == 1, bad
    assert faults(1, {"minimum": 0}, {}), "a keyword that is not checked"


if sys.argv[1:] == ["--planted"]:
    planted()
else:
    check(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3])
