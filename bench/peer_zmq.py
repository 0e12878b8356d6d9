"""Peer: pyzmq over tcp. Streams are PUSH/PULL, requests REQ/REP, the fan PUB/SUB."""

import struct

import zmq
from peer import main, ready
from workload import KILOBYTE_TEXT, NUMBER, READERS

SMALL = struct.Struct("<id")
INDEX = struct.Struct("<i")
context = zmq.Context.instance()


def bind(kind):
    """A socket on a port of the system's choice, and that port."""
    bound = context.socket(kind)
    return bound, bound.bind_to_random_port("tcp://127.0.0.1")


def connect(kind, port):
    connected = context.socket(kind)
    connected.connect(f"tcp://127.0.0.1:{port}")
    return connected


def bind_streams():
    inlet, there = bind(zmq.PULL)
    outlet, back = bind(zmq.PUSH)
    ready(there=there, back=back)
    return inlet, outlet


def connect_streams(options):
    return connect(zmq.PUSH, options.at["there"]), connect(zmq.PULL, options.at["back"])


def serve_stream(options):
    inlet, outlet = bind_streams()
    while True:
        index, number = SMALL.unpack(inlet.recv())
        outlet.send(SMALL.pack(index, number))


def stream(options):
    outlet, inlet = connect_streams(options)

    def exchange(index):
        outlet.send(SMALL.pack(index, NUMBER))
        assert SMALL.unpack(inlet.recv())[0] == index

    return exchange


def serve_rpc(options):
    service, port = bind(zmq.REP)
    ready(port=port)
    while True:
        index, number = SMALL.unpack(service.recv())
        service.send(SMALL.pack(index, number))


def rpc(options):
    client = connect(zmq.REQ, options.at["port"])

    def exchange(index):
        client.send(SMALL.pack(index, NUMBER))
        assert SMALL.unpack(client.recv())[0] == index

    return exchange


def serve_large(options):
    inlet, outlet = bind_streams()
    while True:
        outlet.send(inlet.recv(copy=False), copy=False)


def large(options):
    outlet, inlet = connect_streams(options)
    image = bytearray(options.side * options.side)

    def exchange(index):
        outlet.send(image, copy=False)
        assert len(inlet.recv(copy=False).buffer) == len(image)

    return exchange


def serve_flood(options):
    inlet, outlet = bind_streams()
    while True:
        index, number = SMALL.unpack(inlet.recv())
        if index == 0:
            outlet.send(SMALL.pack(index, number))


def flood(options):
    outlet, inlet = connect_streams(options)

    def burst(count):
        for index in reversed(range(count)):
            outlet.send(SMALL.pack(index, NUMBER))
        inlet.recv()

    return burst


def serve_fan(options):
    inlet, outlet = bind_streams()
    publisher = inlet.recv_json()
    readers = [connect(zmq.SUB, publisher) for _ in range(READERS)]
    for reader in readers:
        reader.subscribe(b"")
    while True:
        for reader in readers:
            index = INDEX.unpack_from(reader.recv())[0]
        outlet.send(INDEX.pack(index))


def fan(options):
    control, inlet = connect_streams(options)
    # The extended publisher hears of subscriptions, so that the start waits for all of them.
    outlet = context.socket(zmq.XPUB)
    outlet.setsockopt(zmq.XPUB_VERBOSE, 1)
    control.send_json(outlet.bind_to_random_port("tcp://127.0.0.1"))
    for _ in range(READERS):
        outlet.recv()
    text = KILOBYTE_TEXT.encode()

    def exchange(index):
        outlet.send(INDEX.pack(index) + text)
        assert INDEX.unpack(inlet.recv())[0] == index

    return exchange


if __name__ == "__main__":
    main(
        {
            "stream": (serve_stream, stream),
            "rpc": (serve_rpc, rpc),
            "large": (serve_large, large),
            "flood": (serve_flood, flood),
            "fan": (serve_fan, fan),
        }
    )
