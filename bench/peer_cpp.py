"""Peer: C++ YARP through its Python binding, `--carrier tcp` (acknowledged) or `fast_tcp`.

Started with CPython 3.10 of the environment that tests/support/cpp_venv.py prepares, and with a C++
name server configured. Writers are plain Ports (they send in the caller), readers BufferedPorts.
"""

import os

from peer import main, ready
from workload import KILOBYTE_TEXT, NUMBER, READERS

import yarp

PREFIX = f"/bench{os.getpid()}"


def opened(port, name):
    assert port.open(PREFIX + name)
    return port


def connect(source, destination, carrier):
    assert yarp.Network.connect(source, destination, carrier)


def small(index):
    message = yarp.Bottle()
    message.addInt32(index)
    message.addFloat64(NUMBER)
    return message


def serve_ports(reader):
    inlet, outlet = opened(reader, "/there"), opened(yarp.Port(), "/back")
    ready(inlet=PREFIX + "/there", outlet=PREFIX + "/back")
    return inlet, outlet


def client_ports(options, reader):
    outlet, inlet = opened(yarp.Port(), "/out"), opened(reader, "/in")
    connect(PREFIX + "/out", options.at["inlet"], options.carrier)
    connect(options.at["outlet"], PREFIX + "/in", options.carrier)
    return outlet, inlet


def serve_stream(options):
    inlet, outlet = serve_ports(yarp.BufferedPortBottle())
    while True:
        outlet.write(inlet.read())


def stream(options):
    outlet, inlet = client_ports(options, yarp.BufferedPortBottle())

    def exchange(index):
        outlet.write(small(index))
        assert inlet.read().get(0).asInt32() == index

    return exchange


def serve_rpc(options):
    service = opened(yarp.RpcServer(), "/service")
    ready(inlet=PREFIX + "/service")
    message = yarp.Bottle()
    while True:
        if service.read(message, True):
            service.reply(message)


def rpc(options):
    client = opened(yarp.RpcClient(), "/client")
    connect(PREFIX + "/client", options.at["inlet"], options.carrier)
    reply = yarp.Bottle()

    def exchange(index):
        assert client.write(small(index), reply)
        assert reply.get(0).asInt32() == index

    return exchange


def serve_large(options):
    inlet, outlet = serve_ports(yarp.BufferedPortImageMono())
    while True:
        outlet.write(inlet.read())


def large(options):
    outlet, inlet = client_ports(options, yarp.BufferedPortImageMono())
    pixels = bytearray(options.side * options.side)
    image = yarp.ImageMono()
    image.setExternal(memoryview(pixels), options.side, options.side)

    def exchange(index, _keep=pixels):  # the image does not hold what it looks at
        outlet.write(image)
        assert inlet.read().width() == options.side

    return exchange


def serve_flood(options):
    reader = yarp.BufferedPortBottle()
    reader.setStrict(True)
    inlet, outlet = serve_ports(reader)
    while True:
        message = inlet.read()
        if message.get(0).asInt32() == 0:
            outlet.write(message)


def flood(options):
    outlet, inlet = client_ports(options, yarp.BufferedPortBottle())

    def burst(count):
        for index in reversed(range(count)):
            outlet.write(small(index))
        inlet.read()

    return burst


def serve_fan(options):
    readers = [opened(yarp.BufferedPortBottle(), f"/reader{i}") for i in range(READERS)]
    outlet = opened(yarp.Port(), "/back")
    ready(readers=[reader.getName() for reader in readers], outlet=PREFIX + "/back")
    while True:
        for reader in readers:
            index = reader.read().get(0).asInt32()
        outlet.write(small(index))


def fan(options):
    outlet, inlet = opened(yarp.Port(), "/out"), opened(yarp.BufferedPortBottle(), "/in")
    for reader in options.at["readers"]:
        connect(PREFIX + "/out", reader, options.carrier)
    connect(options.at["outlet"], PREFIX + "/in", "tcp")

    def exchange(index):
        message = yarp.Bottle()
        message.addInt32(index)
        message.addString(KILOBYTE_TEXT)
        outlet.write(message)
        assert inlet.read().get(0).asInt32() == index

    return exchange


if __name__ == "__main__":
    yarp.Network.init()
    main(
        {
            "stream": (serve_stream, stream),
            "rpc": (serve_rpc, rpc),
            "large": (serve_large, large),
            "flood": (serve_flood, flood),
            "fan": (serve_fan, fan),
        }
    )
