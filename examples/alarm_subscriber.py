#!/usr/bin/env python3
"""Prints every change of an alarm: alarm_subscriber.py [LCM_URL]."""
import json
import subprocess
import sys


def lines(url):
    """The objects that `spoolwatch listen` prints."""
    command = ["spoolwatch", "listen", "--json", "--alarms"] + (["--lcm-url", url] if url else [])
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as listen:
        for line in listen.stdout:
            yield json.loads(line)


def main():
    severities = {}
    for message in lines(sys.argv[1] if len(sys.argv) > 1 else ""):
        if message["type"] == "run":  # the daemon was started again
            severities.clear()
        if message["type"] != "alarm":
            continue
        name = message["source"] + "." + message["name"]
        severity = message["severity"] if message["active"] else "OK"
        if severities.get(name, "OK") != severity:  # active alarms are repeated every second
            print(f"{severity:8} {name}: {message['quantity']} = {message['value']}, {message['reason']}", flush=True)
        severities[name] = severity


main()
