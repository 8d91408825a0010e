"""What a misbehaving Modbus device makes of its replies: kinds of trouble by name, on TCP and on a serial line.

A trouble is a function of request and reply (frames of TCP) that gives parts: (ms to wait, bytes).
"""
import random
import struct

READ, WRITES = 3, (6, 16)
COMMAND, POSITION, E_STOP = 2, 4, 11


class Close(Exception):
    """Ends the connection; reset: with an RST."""

    def __init__(self, reset=False):
        super().__init__()
        self.reset = reset


def whole(request, reply):
    return [(0, reply)]


def delayed(ms):
    return lambda request, reply: [(ms, reply)]


def loris(ms):
    return lambda request, reply: [(ms, bytes([b])) for b in reply]


def edited(edit):
    def spoil(request, reply):
        data = bytearray(reply)
        edit(data)
        return [(0, bytes(data))]
    return spoil


def put(at, value):
    return edited(lambda d: d.__setitem__(at, value(d[at]) if callable(value) else value))


def length(value):
    return edited(lambda d: d.__setitem__(slice(4, 6), struct.pack(">H", value(len(d) - 6) & 0xFFFF)))


def refused(code, functions=None):
    def spoil(request, reply):
        if functions and request[7] not in functions:
            return [(0, reply)]
        return [(0, reply[:4] + b"\0\3" + bytes([reply[6], request[7] | 0x80, code]))]
    return spoil


def only(functions, spoil):
    return lambda request, reply: spoil(request, reply) if request[7] in functions else [(0, reply)]


def register(address, words):
    """The value of a register in replies to reads."""
    def spoil(request, reply):
        first, count = struct.unpack(">HH", request[8:12])
        if request[7] != READ or not first <= address < first + count:
            return [(0, reply)]
        data = bytearray(reply)
        at = 9 + 2 * (address - first)
        data[at:at + len(words)] = words
        return [(0, bytes(data))]
    return spoil


def position(value):
    return register(POSITION, struct.pack(">f", value))


def close(reset):
    def spoil(request, reply):
        raise Close(reset)
    return spoil


def garbage(size):
    return lambda request, reply: [(0, random.Random(size).randbytes(size))]


TROUBLES = {
    **{f"{ms} ms late": delayed(ms) for ms in (1, 3, 8, 20, 60, 200)},
    **{f"slow, {ms} ms a byte": loris(ms) for ms in (0.2, 1, 5)},
    "lost": lambda request, reply: [],
    "lost on reads": only((READ,), lambda request, reply: []),
    "lost on writes": only(WRITES, lambda request, reply: []),
    "cut by a byte": lambda request, reply: [(0, reply[:-1])],
    "cut in the header": lambda request, reply: [(0, reply[:5])],
    "twice": lambda request, reply: [(0, reply + reply)],
    "twice, 1.2 ms apart": lambda request, reply: [(0, reply), (1.2, reply)],
    "trailing byte": lambda request, reply: [(0, reply + b"\0")],
    "of the next transaction": put(1, lambda b: (b + 1) & 0xFF),
    "of transaction 0": edited(lambda d: d.__setitem__(slice(0, 2), b"\0\0")),
    "of another protocol": put(3, 1),
    "of the next unit": put(6, lambda b: (b + 1) & 0xFF),
    "of unit 0": put(6, 0),
    "of unit 255": put(6, 255),
    "length 0": length(lambda n: 0),
    "length 1": length(lambda n: 1),
    "length + 1": length(lambda n: n + 1),
    "length - 1": length(lambda n: n - 1),
    "length 65535": length(lambda n: 65535),
    "of another function": put(7, lambda b: b ^ 0x15),
    "function 0": put(7, 0),
    "count too large": only((READ,), put(8, lambda b: b + 2)),
    "count too small": only((READ,), put(8, lambda b: b - 2)),
    "count 0": only((READ,), put(8, 0)),
    "confirms the next address": only(WRITES, put(9, lambda b: (b + 1) & 0xFF)),
    "confirms another number": only(WRITES, put(11, lambda b: (b + 1) & 0xFF)),
    "garbage of 3": garbage(3),
    "garbage of 12": garbage(12),
    "garbage of 300": garbage(300),
    **{f"exception {code}": refused(code) for code in (1, 4, 6, 11)},
    **{f"exception {code} on reads": refused(code, (READ,)) for code in (2, 4, 11)},
    "exception 4 on writes": refused(4, WRITES),
    "exception 0": refused(0),
    "exception 200": refused(200),
    "closes": close(False),
    "resets": close(True),
    "position NaN": position(float("nan")),
    "position infinite": position(float("inf")),
    "position out of range": position(50.0),
    "position below range": position(-50.0),
    "e-stop 0": register(E_STOP, b"\0\0"),
    "e-stop 0xABCD": register(E_STOP, b"\xab\xcd"),
}
ON_ACCEPT = {  # what a new connection finds
    "garbage on accept": lambda c: c.sendall(b"\0\1\0\0\0\3\1\x83\x04"),
    "closed on accept": lambda c: (_ for _ in ()).throw(Close()),
    "reset on accept": lambda c: (_ for _ in ()).throw(Close(True)),
}


# What a serial line has not: transactions and connections.
ON_TCP_ALONE = ("of the next transaction", "of transaction 0", "of another protocol", "length", "closes", "resets")
# Of the bytes on the line; the others are of what they say, and get the check that belongs to it.
OF_BYTES = ("1 ms", "3 ms", "8 ms", "20 ms", "60 ms", "200 ms", "slow", "lost", "cut", "twice", "trailing", "garbage")


def check_sum(frame):
    """Of a frame on a serial line."""
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return struct.pack("<H", crc)


def on_the_line(frame):
    """A frame of TCP as one of a serial line."""
    return frame[6:] + check_sum(frame[6:])


def of_line(name, spoil):
    """A trouble as it is on a serial line: (request of TCP, reply of TCP) -> parts."""
    if name.startswith(OF_BYTES):
        return lambda request, reply: spoil(request, on_the_line(reply))
    return lambda request, reply: [(ms, on_the_line(part)) for ms, part in spoil(request, reply)]


ON_RTU = {name: of_line(name, spoil) for name, spoil in TROUBLES.items() if not name.startswith(ON_TCP_ALONE)}
ON_RTU["wrong check"] = lambda request, reply: [(0, on_the_line(reply)[:-1] + bytes([on_the_line(reply)[-1] ^ 1]))]
