"""The C++ program `yarp latency-test` as a client of yarpy ports: calls, and streams and back.

Its client says `start SIZE REPLY`, then sends `NUMBER TIME` and wants them back, with a payload of
that size, as a reply (REPLY 1) or over the server's own output (0).
"""

import re

import pytest
from support.cpp import CppYarp

import yarpy
from yarpy import Message

FRAMES = 200
SERVER = "/latencyTest/server"


def measured(programs: CppYarp, *options: str) -> float:
    """The average latency in milliseconds that the program finds."""
    common = ("--nframes", str(FRAMES), "--payload_size", "1000")
    result = programs.run("latency-test", "--client", *common, *options)
    assert result.returncode == 0, result.stderr
    found = re.search(
        rf"Processed {FRAMES} frames of 1000 bytes,.* average latency ([\d.]+)\[ms\]", result.stdout
    )
    assert found, result.stdout
    return float(found[1])


@pytest.mark.parametrize("carrier", ["tcp", "text_ack"])
def test_calls(our_names: CppYarp, carrier: str) -> None:
    asked: list[int] = []
    payload = ""

    def echo(message: Message) -> object:
        nonlocal payload
        match message.value:
            case ["start", size, 1]:
                payload = "x" * size
            case [int(number), float(moment)]:
                asked.append(number)
                return [number, moment, payload]
            case _:
                return None

    with yarpy.RpcServer(SERVER, echo):
        assert measured(our_names, "--protocol", carrier) < 100
    assert asked == list(range(FRAMES))


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "mcast", "text", "text_ack"])
def test_streams(our_names: CppYarp, carrier: str) -> None:
    received: list[int] = []
    payload = ""

    def send_back(message: Message) -> None:
        nonlocal payload
        match message.value:
            case ["start", size, 0]:
                payload = "x" * size
            case [int(number), float(moment)]:
                received.append(number)
                port.write([number, moment, payload])

    with yarpy.Port(SERVER, callback=send_back) as port:
        assert measured(our_names, "--protocol", carrier, "--no-reply") < 100
    assert received == list(range(FRAMES))
