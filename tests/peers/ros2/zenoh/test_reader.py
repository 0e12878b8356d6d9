"""The subscription of a port: how long it waits, what wakes it, and what it leaves out."""

from __future__ import annotations

import _thread
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import pytest
from support.wait import HANG

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.carrier import Incoming
from yarpy.peers.ros2.kind import key_of
from yarpy.peers.ros2.name import check_node
from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.ros2.zenoh.endpoint import BESIDE
from yarpy.peers.ros2.zenoh.participant import take_part
from yarpy.peers.ros2.zenoh.reader import MOST, WAKE, Reader
from yarpy.peers.zenoh.transport import share

TYPE = "std_msgs/msg/String"
String = ros2.load(TYPE)
Put = Callable[..., None]


@contextmanager
def reading(topic: str, depth: int = 3) -> Iterator[Reader]:
    """A subscription that has been greeted."""
    node, qos = check_node("/reads"), ros2.qos_profile(depth=depth)
    found = Reader(take_part(0), "/in", node, topic, qos)
    try:
        found.begin(TYPE, False, 0.0)
        assert found.receive() == (found,)
        yield found
    finally:
        found.close()


@pytest.fixture
def put(names: yarpy.LocalNames) -> Iterator[Put]:
    """Puts a message with a number, in this program."""
    with share() as shared:

        def put(topic: str, number: int, below: str = "") -> None:
            key, beside = key_of(0, topic, String, False), attachment(number, 1, bytes(16))
            shared.session.put(
                f"{key}{below}", b"".join(String(data="x").to_ros()), attachment=beside
            )

        yield put


def number(came: tuple[object] | None) -> int:
    assert came is not None and isinstance(came[0], Incoming)
    return came[0].number


def test_the_oldest_are_left_out_and_counted(put: Put) -> None:
    with reading("/oldest") as reader:
        for at in range(1, 11):
            put("/oldest", at)
        assert [number(reader.receive()) for _ in range(3)] == [8, 9, 10]
        put("/oldest", 11)
        assert number(reader.receive()) == 11
        assert reader.dropped == 0  # nobody knows of any before the first that was read
        for at in range(12, 17):
            put("/oldest", at)
        assert [number(reader.receive(wait=False)) for _ in range(3)] == [14, 15, 16]
        assert reader.dropped == 2


def test_a_wait_has_its_limit(put: Put) -> None:
    with reading("/limit") as reader:
        with pytest.raises(BlockingIOError):
            reader.receive(wait=False)
        reader.limit_waiting(0.02)
        for _ in range(2):
            with pytest.raises(BlockingIOError):
                reader.receive()
        reader.limit_waiting(HANG)
        put("/limit", 1)
        assert number(reader.receive()) == 1


@pytest.mark.parametrize("end", ["interrupt", "close"])
@pytest.mark.parametrize("depth", [3, MOST + 1])
def test_who_waits_is_woken(put: Put, end: str, depth: int) -> None:
    """Also where many messages may wait, and so do in the inbox."""
    with reading("/woken", depth) as reader, ThreadPoolExecutor() as pool:
        put("/woken", 1)
        assert number(reader.receive()) == 1
        waiting = pool.submit(reader.receive)
        getattr(reader, end)()
        assert waiting.result(HANG) is None
        assert reader.receive() is None


def test_nobody_else_hears_of_a_wake(put: Put) -> None:
    with reading("/both") as one, reading("/both") as other:
        one.interrupt()
        put("/both", 1, WAKE)  # what has a number is a message
        put("/both", 2)
        assert [number(other.receive()) for _ in range(2)] == [1, 2]


def test_what_lyrical_sends_beside_is_heard(put: Put) -> None:
    with reading("/beside") as reader:
        put("/beside", 1, BESIDE)
        assert number(reader.receive()) == 1


def test_after_a_signal_it_goes_on(put: Put) -> None:
    with reading("/signal") as reader:
        timer = threading.Timer(0.05, _thread.interrupt_main)
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            reader.receive()
        timer.join()
        put("/signal", 1)
        assert number(reader.receive()) == 1


def test_a_publisher_that_keeps_messages_is_asked_for_them(put: Put) -> None:
    """What waits in Zenoh comes first, then what the publisher has kept."""
    said = String(data="the map")
    with ros2.Node("/keeps") as node, yarpy.BufferedPort("/in", strict=True) as port:
        port.listen_to(f"ros2://map~{TYPE}")
        put("/map", 1)
        assert port.read(timeout=HANG).value == "x"
        latched = ros2.qos_profile("latched")
        node.publisher("/map", TYPE, qos=latched).write(said)
        assert port.read(timeout=HANG).value == "the map"
        put("/map", 2)
        assert port.read(timeout=HANG).value == "x"
