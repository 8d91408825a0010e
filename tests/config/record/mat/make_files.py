#!/usr/bin/env python3
"""Writes the MAT files of mat_test.cpp, as SciPy does for its users. Usage: make_files.py FOLDER"""
import struct
import sys

import numpy as np
import scipy.io

folder = sys.argv[1]
t_s = np.arange(20) * 0.005
u_V = np.round(np.sin(t_s * 40), 6)
y_mm = 305.0 + np.arange(20) * 0.25


def save(name, variables, **options):
    scipy.io.savemat(f"{folder}/{name}.mat", variables, **options)


def big_endian(name, variables):
    """The same layout with every word the other way round: uncompressed doubles alone."""
    header = b"MATLAB 5.0 MAT-file, big endian".ljust(116) + b"\0" * 8 + b"\x01\x00MI"
    out = header
    for key, values in variables.items():
        text = key.encode()
        body = struct.pack(">IIII", 6, 8, 6, 0) + struct.pack(">IIii", 5, 8, 1, len(values))
        if len(text) <= 4:
            body += struct.pack(">HH", len(text), 1) + text.ljust(4, b"\0")
        else:
            body += struct.pack(">II", 1, len(text)) + text.ljust(8, b"\0")
        body += struct.pack(">II", 9, 8 * len(values)) + struct.pack(f">{len(values)}d", *values)
        out += struct.pack(">II", 14, len(body)) + body
    with open(f"{folder}/{name}.mat", "wb") as file:
        file.write(out)


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def opaque(name, of_class):
    """An object of one of MATLAB's classes: its name, and numbers that point into the file's end."""
    points = np.array([0xDD000000, 2, 1, 1, 1, 1], dtype="<u4").tobytes()
    array = (element(6, struct.pack("<II", 13, 0)) + element(5, struct.pack("<ii", 6, 1))
             + element(1, b"") + element(6, points))
    return element(14, element(6, struct.pack("<II", 17, 0)) + element(1, name.encode())
                   + element(1, b"MCOS") + element(1, of_class.encode()) + element(14, array))


def column(name, values):
    return element(14, element(6, struct.pack("<II", 6, 0))
                   + element(5, struct.pack("<ii", len(values), 1)) + element(1, name.encode())
                   + element(9, np.asarray(values, dtype="<f8").tobytes()))


def with_objects(name, parts):
    """What MATLAB R2022 writes: the objects by name, their values in an array without one."""
    values = element(14, element(6, struct.pack("<II", 9, 0))
                     + element(5, struct.pack("<ii", 1, 8)) + element(1, b"")
                     + element(2, b"\0\1IM\0\0\0\0"))
    header = b"MATLAB 5.0 MAT-file, Platform: GLNXA64".ljust(116) + b"\0" * 8 + b"\0\1IM"
    with open(f"{folder}/{name}.mat", "wb") as file:
        file.write(header + b"".join(parts) + values)


main = {"t_s": t_s, "u_V": u_V, "y_mm": y_mm}
save("rows", main)
save("columns", main, oned_as="column", do_compression=True)
# Numbers that fit are kept in other types: a period in whole milliseconds, raw increments.
save("types", {"t_ms": np.arange(20, dtype=np.int16) * 5, "u_V": u_V.astype(np.float32),
               "y_um": np.arange(20, dtype=np.uint32) * 1000, "on": np.arange(20) > 9})
save("structure", {"note": "stand 3", "run": {**main, "supply_psi": np.full(20, 1000.0)},
                   "settings": {"gain": 2.0}}, do_compression=True)
save("workspace", {**main, "gain": 2.0, "table": np.eye(3), "note": "stand 3",
                   "parts": np.array(["a", 1.0], dtype=object),
                   "force_N": np.where(np.arange(20) == 3, np.nan, 1.0)})
save("two_structures", {"a": main, "b": main})
save("complex", {**main, "u_V": u_V + 1j})
save("matrix", {**main, "y_mm": np.ones((10, 2))})
save("lengths", {**main, "u_V": u_V[:-1]})
save("text", {**main, "t_s": "now"})
save("no_position", {"t_s": t_s, "u_V": u_V, "pos": y_mm})
save("nan", {**main, "y_mm": np.where(np.arange(20) == 3, np.nan, y_mm)})
save("no_unit", {"t": t_s, "u_V": u_V, "y_mm": y_mm})
save("empty", {**main, "u_V": np.zeros((0, 0))})
save("version_4", main, format="4")
big_endian("big_endian", main)
with_objects("timeseries", [opaque("u", "timeseries"), opaque("y", "timeseries")])
with_objects("one_timeseries", [column("t_s", t_s), column("u_V", u_V), opaque("y", "timeseries")])
with_objects("timetable", [opaque("log", "timetable")])
with_objects("beside_objects", [column(name, values) for name, values in main.items()]
             + [opaque("log", "timeseries")])
