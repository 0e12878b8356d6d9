"""Peer: yarpy itself, `--carrier tcp` (acknowledged) or `fast_tcp`; `--spin` for spinning readers.

The server's process also holds the name server. Writers are Ports, readers BufferedPorts. With
`--router` names are on Zenoh, and connections go through a router of it, as between programs that
cannot dial each other.
"""

import os
import threading

import numpy as np
from peer import main, ready, start_router
from workload import KILOBYTE_TEXT, NUMBER, READERS

import yarpy

PREFIX = f"/bench{os.getpid()}"


def name_service(options):
    """What a client's environment needs to find this process's ports."""
    if not options.router:
        global _server  # which ends with this process
        _server = yarpy.NameServer().__enter__()
        return _server.environment
    environment = {"YARPY_SERVER": "zenoh", "YARPY_ZENOH": start_router()}
    os.environ.update(environment)
    return environment


def join(options):
    """Use the name service of the server's process."""
    os.environ.update(options.at["environment"])
    take_no_short_cut(options)


def take_no_short_cut(options):
    """With a router: as if there were no other way."""
    if options.router:
        options.carrier = ""  # the one that is chosen then
        from yarpy.peers.zenoh import reachability as direct

        direct.Reachability.to = lambda self, entry: entry.through


def serve_ports(options, **reading):
    take_no_short_cut(options)
    environment = name_service(options)
    inlet = yarpy.BufferedPort(PREFIX + "/there", **reading)
    outlet = yarpy.Port(PREFIX + "/back")
    ready(environment=environment, inlet=inlet.name, outlet=outlet.name)
    return inlet, outlet


def client_ports(options, **reading):
    join(options)
    outlet = yarpy.Port(PREFIX + "/out")
    inlet = yarpy.BufferedPort(PREFIX + "/in", **reading)
    outlet.connect(options.at["inlet"], options.carrier)
    yarpy.connect(options.at["outlet"], inlet.name, options.carrier)
    return outlet, inlet


def serve_stream(options):
    inlet, outlet = serve_ports(options, spin=options.spin)
    for message in inlet:
        outlet.write(message.value)


def stream(options):
    outlet, inlet = client_ports(options, spin=options.spin)

    def exchange(index):
        outlet.write([index, NUMBER])
        assert inlet.read().value[0] == index

    return exchange


def serve_rpc(options):
    environment = name_service(options)
    with yarpy.RpcServer(PREFIX + "/service", lambda message: message.value) as service:
        ready(environment=environment, inlet=service.name)
        threading.Event().wait()


def rpc(options):
    join(options)
    client = yarpy.RpcClient(options.at["inlet"], carrier=options.carrier)

    def exchange(index):
        assert client.call(index, NUMBER)[0] == index

    return exchange


def serve_large(options):
    inlet, outlet = serve_ports(options)
    for message in inlet:
        outlet.write(message.value)
        del message


def large(options):
    outlet, inlet = client_ports(options)
    shape = (options.side, options.side)
    image = np.zeros(shape, np.uint8)

    def exchange(index):
        outlet.write(image)
        assert inlet.read().value.width == options.side

    def exchange_prepared(index):
        image = outlet.prepare(shape, np.uint8)
        image[0, 0] = index % 256
        outlet.write(image)
        assert inlet.read().value.array[0, 0] == index % 256

    return exchange_prepared if options.prepare else exchange


def serve_flood(options):
    inlet, outlet = serve_ports(options, strict=True)
    for message in inlet:
        value = message.value
        if value[0] == 0:
            outlet.write(value)


def flood(options):
    outlet, inlet = client_ports(options)

    def burst(count):
        for index in reversed(range(count)):
            outlet.write([index, NUMBER])
        inlet.read()

    return burst


def serve_fan(options):
    with yarpy.NameServer() as names:
        readers = [yarpy.BufferedPort(f"{PREFIX}/reader{i}") for i in range(READERS)]
        outlet = yarpy.Port(PREFIX + "/back")
        ready(
            environment=names.environment,
            readers=[reader.name for reader in readers],
            outlet=outlet.name,
        )
        while True:
            for reader in readers:
                index = reader.read().value[0]
            outlet.write([index, NUMBER])


def fan(options):
    os.environ.update(options.at["environment"])
    outlet, inlet = yarpy.Port(PREFIX + "/out"), yarpy.BufferedPort(PREFIX + "/in")
    for reader in options.at["readers"]:
        outlet.connect(reader, options.carrier)
    yarpy.connect(options.at["outlet"], inlet.name)

    def exchange(index):
        outlet.write([index, KILOBYTE_TEXT])
        assert inlet.read().value[0] == index

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
