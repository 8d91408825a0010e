"""Takes datagrams as PlotJuggler's UDP server does, and says what came: udp_peer.py"""
import json
import socket

peer = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
peer.bind(("127.0.0.1", 0))
print("port", peer.getsockname()[1], flush=True)


def curves(tree, path=""):
    """The names of the curves and their values, as PlotJuggler flattens a message."""
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from curves(value, f"{path}/{key}")
        elif isinstance(value, (int, float, str, bool)):
            yield f"{path}/{key}", value


while True:
    datagram = peer.recv(65536)
    message = json.loads(datagram)
    stamp = message.pop("timestamp")
    for name, value in curves(message):
        print(len(datagram) <= 1400, stamp, name, value, flush=True)
