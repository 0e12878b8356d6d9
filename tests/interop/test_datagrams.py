"""Pictures as datagrams: C++ readers keep the receive buffer that the system gives them."""

import contextlib
import time

import numpy as np
import pytest
from support.cpp_program import CppProgram
from support.wait import HANG, wait_until

import yarpy

PICTURES = 10
ENOUGH = 3  # on a busy machine readers miss some, from C++ as well; bursts lost nearly all
ROUNDS = 50  # one in which so many come is enough


@pytest.mark.parametrize("carrier", ["udp", "mcast"])
def test_large_pictures_reach_cpp(peer: CppProgram, carrier: str) -> None:
    peer.do("port = yarp.BufferedPortImageRgb(); port.setStrict(True); assert port.open('/cpp')")
    picture = yarpy.Image(np.zeros((480, 640, 3), np.uint8))
    with yarpy.Port("/ours") as port:
        port.connect("/cpp", carrier)
        port.write(picture)  # the first may meet a reader that is still joining the group
        seen = peer.do("port.getPendingReads()")
        for _ in range(ROUNDS):
            for _ in range(PICTURES):
                port.write(picture)
                time.sleep(0.02)
            time.sleep(0.1)
            before, seen = seen, peer.do("port.getPendingReads()")
            if seen - before >= ENOUGH:
                break
        assert seen - before >= ENOUGH


@pytest.mark.parametrize("carrier", ["udp", "mcast"])
def test_large_pictures_come_from_cpp(peer: CppProgram, carrier: str) -> None:
    peer.do(
        "port = yarp.Port(); assert port.open('/cpp')\n"
        "picture = yarp.ImageRgb(); picture.resize(640, 480)"
    )
    with yarpy.BufferedPort("/ours", strict=True) as port:
        assert peer.do(f"yarp.Network.connect('/cpp', '/ours', '{carrier}')")
        assert port.wait_for_inputs(timeout=HANG)
        for _ in range(ROUNDS):
            before = port.inputs[0].stats.messages
            peer.do(f"for _ in range({PICTURES}): port.write(picture); time.sleep(0.01)")
            with contextlib.suppress(AssertionError):
                wait_until(lambda: port.inputs[0].stats.messages >= before + ENOUGH, 0.5)  # noqa: B023
                return
    raise AssertionError("in no round enough pictures have come")
