"""Peer: eclipse-zenoh in peer mode over tcp, without scouting; readers take from a fifo channel.
With `--router` both sides are clients of a router in a process of its own.

Latency workloads send express messages (zenoh's own setting against batching delay), the flood does
not, so that zenoh may batch; a full queue blocks the writer instead of losing messages.
"""

import contextlib
import json
import socket
import struct
import time

import zenoh
from peer import main, ready, start_router
from workload import KILOBYTE_TEXT, NUMBER, READERS

SMALL = struct.Struct("<id")
INDEX = struct.Struct("<i")
THERE, BACK, SERVICE = "bench/there", "bench/back", "bench/service"


def configuration(listen=(), connect=()):
    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("listen/endpoints", json.dumps([*listen]))
    config.insert_json5("connect/endpoints", json.dumps([*connect]))
    return config


def client(endpoints):
    config = configuration(connect=endpoints)
    config.insert_json5("mode", '"client"')
    return zenoh.open(config)


def listening_session(options):
    """A session on a free port, and its endpoint (zenoh does not tell which port 0 became)."""
    if options.router:
        where = start_router()
        return client([where]), where
    while True:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            endpoint = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
        with contextlib.suppress(zenoh.ZError):  # somebody took the port in between
            return zenoh.open(configuration(listen=[endpoint])), endpoint


def connected_session(options):
    if options.router:
        return client(options.at["endpoints"])
    return zenoh.open(configuration(connect=options.at["endpoints"]))


def publisher(opened, key, express=True):
    return opened.declare_publisher(
        key,
        congestion_control=zenoh.CongestionControl.BLOCK,
        reliability=zenoh.Reliability.RELIABLE,
        express=express,
    )


def subscriber(opened, key):
    return opened.declare_subscriber(key, zenoh.handlers.FifoChannel(1024))


def serve(options, echo):
    """Give `echo` every payload of the stream there and a function that sends one back."""
    opened, endpoint = listening_session(options)
    inlet, outlet = subscriber(opened, THERE), publisher(opened, BACK)
    ready(endpoints=[endpoint])
    for sample in inlet:
        echo(sample.payload, outlet.put)


def connect(options, express=True):
    """The two streams, once both are known to reach the other side."""
    opened = connected_session(options)
    outlet, inlet = publisher(opened, THERE, express), subscriber(opened, BACK)
    # Messages are lost until either side knows the other's subscription.
    while inlet.try_recv() is None:
        outlet.put(SMALL.pack(0, NUMBER))  # 0 is what every server answers
        time.sleep(0.05)
    time.sleep(0.2)
    while inlet.try_recv() is not None:
        pass
    return opened, outlet, inlet


def serve_stream(options):
    def echo(payload, put):
        index, number = SMALL.unpack(payload.to_bytes())
        put(SMALL.pack(index, number))

    serve(options, echo)


def stream(options):
    _session, outlet, inlet = connect(options)

    def exchange(index, _keep=_session):
        outlet.put(SMALL.pack(index, NUMBER))
        assert SMALL.unpack(inlet.recv().payload.to_bytes())[0] == index

    return exchange


def serve_rpc(options):
    opened, endpoint = listening_session(options)
    service = opened.declare_queryable(SERVICE, zenoh.handlers.FifoChannel(16))
    ready(endpoints=[endpoint])
    for query in service:
        index, number = SMALL.unpack(query.payload.to_bytes())
        query.reply(SERVICE, SMALL.pack(index, number), express=True)
        query.drop()


def rpc(options):
    opened = connected_session(options)
    asker = opened.declare_querier(SERVICE, express=True)

    def call(index):
        for reply in asker.get(payload=SMALL.pack(index, NUMBER)):
            return SMALL.unpack(reply.ok.payload.to_bytes())[0]
        return None

    while call(0) is None:  # until the queryable is known here
        time.sleep(0.05)

    def exchange(index, _keep=opened):
        assert call(index) == index

    return exchange


def serve_large(options):
    # A picture is of use in one piece, which for zenoh is a copy.
    serve(options, lambda payload, put: put(payload.to_bytes()))


def large(options):
    _session, outlet, inlet = connect(options)
    image = bytes(options.side * options.side)

    def exchange(index, _keep=_session):
        outlet.put(image)
        assert len(inlet.recv().payload.to_bytes()) == len(image)

    return exchange


def serve_flood(options):
    def echo(payload, put):
        index, number = SMALL.unpack(payload.to_bytes())
        if index == 0:
            put(SMALL.pack(index, number))

    serve(options, echo)


def flood(options):
    _session, outlet, inlet = connect(options, express=False)

    def burst(count, _keep=_session):
        for index in reversed(range(count)):
            outlet.put(SMALL.pack(index, NUMBER))
        inlet.recv()

    return burst


def serve_fan(options):
    # One session per reader: readers in one session would share one message on the wire.
    opened, endpoints = zip(*(listening_session(options) for _ in range(READERS)), strict=True)
    readers = [subscriber(one, THERE) for one in opened]
    outlet = publisher(opened[0], BACK)
    ready(endpoints=endpoints)
    while True:
        for reader in readers:
            index = INDEX.unpack_from(reader.recv().payload.to_bytes())[0]
        outlet.put(INDEX.pack(index))


def fan(options):
    opened = connected_session(options)
    outlet, inlet = publisher(opened, THERE), subscriber(opened, BACK)
    time.sleep(2)  # all subscriptions and the way back are known by then
    text = KILOBYTE_TEXT.encode()

    def exchange(index, _keep=opened):
        outlet.put(INDEX.pack(index) + text)
        assert INDEX.unpack(inlet.recv().payload.to_bytes())[0] == index

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
