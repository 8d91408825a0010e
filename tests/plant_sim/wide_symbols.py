#!/usr/bin/python3
"""Object files compiled for a wide instruction set must define nothing that the rest of the program
could link against by the same name: the linker keeps one copy, and a machine without those
instructions would run it. Allowed are the factory and what carries the lanes' width in its name.

  wide_symbols.py NM OBJECT...
"""
import re
import subprocess
import sys

OURS = re.compile(r"SimdVector<[48]|SimdRegister<[48]|SimdMask<[48]|__vector\([48]\)"
                  r"|new_avx(2|512)_lanes\(|^DW\.ref\.")


def main():
    nm, *objects = sys.argv[1:]
    bad, seen = [], 0
    for path in objects:
        out = subprocess.run([nm, "-C", "--defined-only", "-g", path], check=True,
                             capture_output=True, text=True).stdout
        for line in out.splitlines():
            parts = line.split(maxsplit=2)
            if len(parts) < 3:
                continue
            seen += 1
            if not OURS.search(parts[2]):
                bad.append(f"{path}: {parts[1]} {parts[2]}")
    print("\n".join(bad) if bad else f"{seen} symbols, all of their own")
    return 1 if bad or not seen else 0


if __name__ == "__main__":
    sys.exit(main())
