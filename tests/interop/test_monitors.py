"""Monitors of ours on connections with C++ YARP 3.5, whose own end has none of them.

C++ names the monitors in its greeting, writes and reads what travels, and knows no more.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from support.cpp import CppYarp
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy
from yarpy.monitors.imaging import demosaic

ZLIB = "bottle_compression_zlib"


@pytest.fixture(scope="module")
def peer(our_names: CppYarp) -> Iterator[CppProgram]:
    """A C++ program with the port `/cpp`."""
    with CppProgram(our_names) as program:
        program.do("import ctypes, zlib\nport = yarp.Port()\nassert port.open('/cpp')")
        yield program


def test_cpp_reads_what_we_compressed(peer: CppProgram) -> None:
    with yarpy.Port("/ours") as port:
        port.connect("/cpp", f"tcp+send.{ZLIB}")
        peer.begin("bottle = yarp.Bottle()\nassert port.read(bottle)\nbottle.toString()")
        port.write(["hello", 1, 2, 3])
        size, data = yarpy.Bottle.from_text(peer.end())
    plain = zlib.decompress(data)
    assert (size, plain) == (len(plain), yarpy.Bottle(["hello", 1, 2, 3]).to_bytes())


def test_we_read_what_cpp_compressed(peer: CppProgram) -> None:
    with yarpy.Port("/ours") as port:
        assert peer.do(f"yarp.Network.connect('/cpp', '/ours', 'tcp+recv.{ZLIB}')")
        wait_until(lambda: port.inputs)
        plain = yarpy.Bottle(["hello", 1, [2.5]]).to_bytes()
        text = yarpy.Bottle([len(plain), zlib.compress(plain)]).to_text()
        peer.begin(f"bottle = yarp.Bottle({text!r})\nport.write(bottle)")
        assert port.read(timeout=HANG).value == ["hello", 1, [2.5]]
        assert peer.end()
        assert peer.do("yarp.Network.disconnect('/cpp', '/ours')")


@pytest.mark.parametrize(
    ("tokens", "width", "make"),
    [
        ("", 16, demosaic.bilinear),
        ("+order.rggb+method.simple", 16, demosaic.simple),
        ("+size.half", 13, demosaic.halved),
    ],
)
def test_camera_of_cpp(peer: CppProgram, tokens: str, width: int, make: Any) -> None:
    with yarpy.Port("/ours") as port:
        assert peer.do(f"yarp.Network.connect('/cpp', '/ours', 'tcp+recv.bayer{tokens}')")
        wait_until(lambda: port.inputs)
        grey = (np.arange(12 * width).reshape(12, width) * 37 % 251).astype("u1")
        peer.begin(
            f"image = yarp.ImageMono()\nimage.setQuantum(1)\nimage.resize({width}, 12)\n"
            f"ctypes.memmove(int(image.getRawImage()), bytes.fromhex('{grey.tobytes().hex()}'),"
            " image.getRawImageSize())\n"
            "stamp = yarp.Stamp(5, 2.5)\nport.setEnvelope(stamp)\nport.write(image)"
        )
        message = port.read(timeout=HANG)
        assert peer.end()
        assert message.stamp == yarpy.Stamp(5, 2.5)
        order = demosaic.pattern("rggb" if "rggb" in tokens else "grbg")
        np.testing.assert_array_equal(message.as_(yarpy.Image).array, make(grey, *order))
        assert peer.do("yarp.Network.disconnect('/cpp', '/ours')")


def test_cpp_looks_on_at_calls(peer: CppProgram) -> None:
    peer.do("monitor = yarp.Port()\nassert monitor.open('/monitor')")
    with yarpy.RpcServer("/server", lambda message: ["pong"]), yarpy.RpcClient(name="/ask") as ask:
        ask.connect("/server", "tcp+send.rpc_monitor")
        peer.begin(
            "said = []\nfor _ in range(2):\n"
            "    bottle = yarp.Bottle()\n    assert monitor.read(bottle)\n"
            "    said.append([bottle.get(i).toString() for i in range(1, 9)])"
        )
        assert ask.call("ping") == ["pong"]
        peer.end()
        assert peer.do("said") == [
            ["/ask", "/server", "command", "client", "RpcMonitor", "ping", "ping", ""],
            ["/ask", "/server", "reply", "rpc client", "RpcMonitor", "", "", "pong"],
        ]
    peer.do("monitor.close()")
