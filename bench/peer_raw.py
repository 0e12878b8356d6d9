"""Peer: a blocking Python socket with TCP_NODELAY, the least a Python program can do.

Frames: a 4-byte length, then an int32 and a float64, or the bytes themselves.
"""

import socket
import struct

from peer import main, ready
from workload import KILOBYTE_TEXT, NUMBER, READERS

SMALL = struct.Struct("<id")
LENGTH = struct.Struct("<i")


class Line:
    """Frames over one connected socket."""

    def __init__(self, connected):
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket = connected
        self.rest = b""
        self.large = bytearray()

    def send(self, payload):
        self.socket.sendall(LENGTH.pack(len(payload)) + payload)

    def receive(self):
        """The next small frame; takes from the socket as much as there is."""
        while True:
            if len(self.rest) >= 4:
                end = 4 + LENGTH.unpack_from(self.rest)[0]
                if len(self.rest) >= end:
                    payload, self.rest = self.rest[4:end], self.rest[end:]
                    return payload
            more = self.socket.recv(65536)
            if not more:
                raise SystemExit
            self.rest += more

    def send_large(self, payload):
        waiting = [LENGTH.pack(len(payload)), payload]
        sent = self.socket.sendmsg(waiting)
        if sent < 4 + len(payload):
            self.socket.sendall(memoryview(payload)[sent - 4 :])

    def receive_large(self):
        """The next frame, in a buffer that the next one overwrites: no copy, no zeroing."""
        length = LENGTH.unpack(self.socket.recv(4, socket.MSG_WAITALL))[0]
        if len(self.large) != length:
            self.large = bytearray(length)
        free = memoryview(self.large)
        while free:
            free = free[self.socket.recv_into(free) :]
        return self.large


def accept(count=1):
    with socket.create_server(("127.0.0.1", 0), backlog=count) as listener:
        ready(port=listener.getsockname()[1])
        return [Line(listener.accept()[0]) for _ in range(count)]


def connect(options):
    return Line(socket.create_connection(("127.0.0.1", options.at["port"])))


def serve_stream(options):
    [line] = accept()
    while True:
        index, number = SMALL.unpack(line.receive())
        line.send(SMALL.pack(index, number))


def stream(options):
    line = connect(options)

    def exchange(index):
        line.send(SMALL.pack(index, NUMBER))
        assert SMALL.unpack(line.receive())[0] == index

    return exchange


def serve_large(options):
    [line] = accept()
    while True:
        line.send_large(line.receive_large())


def large(options):
    line = connect(options)
    image = bytearray(options.side * options.side)

    def exchange(index):
        line.send_large(image)
        assert len(line.receive_large()) == len(image)

    return exchange


def serve_flood(options):
    [line] = accept()
    while True:
        index, number = SMALL.unpack(line.receive())
        if index == 0:
            line.send(SMALL.pack(index, number))


def flood(options):
    line = connect(options)

    def burst(count):
        for index in reversed(range(count)):
            line.send(SMALL.pack(index, NUMBER))
        line.receive()

    return burst


def serve_fan(options):
    lines = accept(READERS)
    while True:
        for line in lines:
            index = LENGTH.unpack_from(line.receive())[0]
        lines[0].send(LENGTH.pack(index))


def fan(options):
    lines = [connect(options) for _ in range(READERS)]
    text = KILOBYTE_TEXT.encode()

    def exchange(index):
        payload = LENGTH.pack(index) + text
        for line in lines:
            line.send(payload)
        assert LENGTH.unpack(lines[0].receive())[0] == index

    return exchange


if __name__ == "__main__":
    main(
        {
            "stream": (serve_stream, stream),
            "rpc": (serve_stream, stream),
            "large": (serve_large, large),
            "flood": (serve_flood, flood),
            "fan": (serve_fan, fan),
        }
    )
