"""Peek: the newest message is there, the port loses nothing and waits for nobody."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.network.peek import Peek


@pytest.fixture
def out(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/out", names=names) as port:
        yield port


def test_the_newest_message_is_kept(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=names) as inlet:
        out.connect("/in")
        with Peek(out.contact) as peek:
            assert peek.newest is None
            wait_until(lambda: len(out.outputs) == 2)
            for number in range(1000):
                out.write([number])
            wait_until(lambda: peek.count == 1000)
            assert peek.newest is not None
            assert peek.newest.value == yarpy.Bottle([999])
            assert [inlet.read(timeout=HANG).value[0] for _ in range(1000)] == list(range(1000))
        wait_until(lambda: len(out.outputs) == 1)
        assert out.outputs[0].stats.drops == 0


def test_pictures_come_whole(out: yarpy.Port) -> None:
    picture = np.arange(480 * 640 * 3, dtype=np.uint8).reshape(480, 640, 3)
    with Peek(out.contact) as peek:
        wait_until(lambda: out.outputs)
        out.write(yarpy.Image(picture))
        wait_until(lambda: peek.newest is not None)
        assert peek.newest is not None
        np.testing.assert_array_equal(peek.newest.as_(yarpy.Image).array, picture)


def test_questions_and_answers_of_a_server(names: yarpy.LocalNames) -> None:
    with (
        yarpy.RpcServer("/double", lambda message: 2 * message.value[0], names=names) as server,
        yarpy.RpcClient(names=names) as client,
        Peek(server.contact, questions=True) as peek,
    ):
        client.connect("/double")
        wait_until(lambda: server.outputs)
        client.ask([21])
        wait_until(lambda: peek.newest is not None)
        assert peek.newest is not None
        assert "21" in str(peek.newest.value)
        assert "42" in str(peek.newest.value)


def test_the_end_of_the_port_is_told(out: yarpy.Port) -> None:
    with Peek(out.contact) as peek:
        wait_until(lambda: out.outputs)
        out.close()
        wait_until(lambda: peek.ended)


def test_nobody_there_is_an_error() -> None:
    with pytest.raises(yarpy.LinkClosed):
        Peek(yarpy.Contact("tcp", "/gone", "127.0.0.1", 1))
