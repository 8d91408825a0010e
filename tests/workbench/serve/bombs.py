#!/usr/bin/env python3
"""Uploads that unpack to far more than they are, or state sizes that nothing has: each is refused in one
line, with little memory and nothing left behind.

  bombs.py --bin DIR
"""
import argparse
import gzip
import http.client
import json
import pathlib
import struct
import sys
import tempfile
import urllib.parse
import zipfile
import zlib

sys.dont_write_bytecode = True
from server_process import NoPage, Server  # noqa: E402

MOST_GROWTH_KB = 600_000  # a MAT file is unpacked up to 64 MiB, a line of text held up to its limit


def mat_element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def mat_bomb(numbers):
    """A MAT file of version 5 with one packed column of zeros."""
    head = mat_element(6, struct.pack("<II", 6, 0)) + mat_element(5, struct.pack("<ii", numbers, 1)) \
        + mat_element(1, b"t_s")
    packer = zlib.compressobj(9)
    packed = packer.compress(struct.pack("<II", 14, len(head) + 8 + 8 * numbers) + head
                             + struct.pack("<II", 9, 8 * numbers))
    for _ in range(8 * numbers >> 20):
        packed += packer.compress(b"\0" * (1 << 20))
    packed += packer.flush()
    return (b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"
            + struct.pack("<II", 15, len(packed)) + packed)


def lcm_event(size):
    """An LCM log whose first event states `size` bytes of data."""
    return struct.pack(">IQQII", 0xEDA1DA01, 0, 0, 17, size) + b"SPOOLWATCH_SAMPLE" + b"\0" * 100


def zip_bomb(folder):
    file = folder / "book.zip"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as book:
        book.writestr("xl/workbook.xml", b"\0" * (64 << 20))
    return file.read_bytes()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    program = parser.parse_args().bin / "spoolwatch"
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        bombs = {
            "wide.csv": b"t_s,u_V,y_m" + b",c" * 20_000_000 + b"\n0,1,2\n",
            "packed.mat": mat_bomb(1 << 26),
            "events.lcm": lcm_event(0x7FFFFFFF),
            "negative.lcm": lcm_event(0xFFFFFFFF),
            "book.xlsx": zip_bomb(folder),
            "text.csv": gzip.compress(b"0,1,2\n" * 5_000_000),
            "text.csv.gz": gzip.compress(b"0,1,2\n" * 5_000_000),
            "nothing.mcap": b"\x89MCAP0\r\n" + b"\xff" * 4096,
            "deep.toml": b"a = " + b"[" * 100_000,
            "keys.toml": b"plant = 'x'\n" + b"".join(b"k%d = 1\n" % i for i in range(100_000)),
        }
        try:
            server = Server(str(program), folder / "session")
        except NoPage as missing:
            print(missing)
            return 77
        with server:
            server.log_in()
            before_kB, before = server.resident_kB(), server.state()
            for name, data in bombs.items():
                connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
                connection.request("POST", "/api/upload?name=" + urllib.parse.quote(name), data,
                                   {"Content-Type": "application/octet-stream", "Cookie": server.cookie,
                                    "X-Spoolwatch-Change": server.change})
                answer = connection.getresponse()
                text = json.loads(answer.read())["error"]
                print(f"{name:14} {len(data):10} bytes: {answer.status} {text[:150]}")
                assert answer.status == 422, answer.status
                assert "\n" not in text and len(text) < 1000, text
                connection.close()
                grown_kB = server.resident_kB() - before_kB
                assert grown_kB < MOST_GROWTH_KB, f"{name}: {grown_kB} kB"
            after = server.state()
            for key in ("record", "model", "files", "lineage", "commands"):
                assert before[key] == after[key], key
    return 0


if __name__ == "__main__":
    sys.exit(main())
