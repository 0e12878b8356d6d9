"""Subscriptions: what is kept, counted and waited for, where the reader waits in Zenoh, and where
it does not."""

from __future__ import annotations

import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from support.main_signal import signalled
from support.wait import HANG, runs, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.kind import key_of
from yarpy.peers.ros2.name import node_of
from yarpy.peers.ros2.qos import PROFILES, Qos
from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.ros2.zenoh.participant import Participant, take_part
from yarpy.peers.ros2.zenoh.subscriber import BESIDE, Subscriber

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')

NAME = "/subscribed"
TEXT = "std_msgs/msg/String"
PICTURE = "sensor_msgs/msg/Image"
WAITS = "Ring.wait"  # the function in which a reader waits in Zenoh
Make = Callable[..., Subscriber]


@pytest.fixture
def make(names: yarpy.LocalNames) -> Iterator[Make]:
    """Begins subscriptions, whose greeting is over."""
    made: list[Subscriber] = []

    def begin(qos: Qos | None = None, type_: str = TEXT) -> Subscriber:
        found = Subscriber(take_part(0), "/in", node_of("/in"), NAME, qos)
        made.append(found)
        found.begin(type_, False, 0.0)
        assert found.receive() == (found,)
        return found

    yield begin
    for one in made:
        one.close()


def put(part: Participant, *numbers: int, type_: str = TEXT, beside: str = "") -> None:
    """Publish, within this session: where nothing kept is asked for, it has come by then."""
    key = str(key_of(0, NAME, ros2.load(type_), False)) + beside
    for number in numbers:
        part.session.put(key, f"{number}".encode(), attachment=attachment(number, 1, bytes(16)))


def came(reader: Subscriber, wait: bool = True) -> int:
    """The number of the next message; 0 if there is none yet, -1 at the end."""
    try:
        found: Any = reader.receive(wait)
    except BlockingIOError:
        return 0
    if found is None:
        return -1
    assert found[0].body == f"{found[0].number}".encode()
    return int(found[0].number)


def all_that_came(reader: Subscriber) -> list[int]:
    return [*iter(lambda: came(reader, wait=False), 0)]


WAYS = {"in the ring": Qos(depth=3), "by the inbox": Qos(durability=1, depth=3)}


@pytest.mark.parametrize("way", WAYS)
def test_the_newest_are_kept(make: Make, way: str) -> None:
    reader = make(WAYS[way])
    assert (reader._ring is None) == (way == "by the inbox")
    put(reader.participant, 1)
    assert came(reader) == 1  # once the library has asked for what was kept
    put(reader.participant, *range(2, 21))
    assert all_that_came(reader) == [18, 19, 20]
    assert reader.dropped == 16
    put(reader.participant, 21, 25)
    assert all_that_came(reader) == [21, 25]
    assert reader.dropped == 19  # three were lost elsewhere


def test_what_is_pushed_out_before_anything_is_read_is_counted(make: Make) -> None:
    """But not what was published before there was a subscription."""
    reader = make(Qos(depth=3))
    put(reader.participant, *range(5, 31))
    assert all_that_came(reader) == [28, 29, 30]
    assert reader.dropped == 23


def test_so_it_is_of_a_publisher_that_comes_later(make: Make) -> None:
    reader = make(Qos(depth=3))
    put(reader.participant, 1)
    assert came(reader) == 1
    wait_until(lambda: reader._firsts and reader._firsts._handle is None)  # it is heard
    with ros2.Node("/later") as node:
        writer = node.publisher(NAME, TEXT)
        wait_until(lambda: reader._firsts and reader._firsts._handle is not None)
        for _ in range(30):
            writer.write("told while nobody reads")
        wait_until(lambda: reader._firsts and reader._firsts._handle is None)
        found = [reader.receive(wait=False) for _ in range(3)]
        assert [item[0].number for item in found if item is not None] == [28, 29, 30]  # type: ignore[attr-defined]
        assert reader.dropped == 27


def test_all_are_kept(make: Make) -> None:
    reader = make(PROFILES["all"])
    put(reader.participant, *range(1, 1001))
    assert all_that_came(reader) == [*range(1, 1001)]
    assert reader.dropped == 0


@pytest.mark.parametrize("way", WAYS)
def test_a_wait_has_a_limit(make: Make, way: str) -> None:
    reader = make(WAYS[way])
    for limit in (0.05, 0.01):
        reader.limit_waiting(limit)
        begun = time.monotonic()
        assert came(reader) == 0
        assert time.monotonic() >= begun + limit
    reader.limit_waiting(HANG)
    put(reader.participant, 1)
    assert came(reader) == 1
    with ThreadPoolExecutor() as pool:
        found = pool.submit(came, reader)
        put(reader.participant, 2)
        assert found.result(HANG) == 2


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("end", ["interrupt", "close"])
def test_the_end_wakes_the_reader(make: Make, way: str, end: str) -> None:
    reader = make(WAYS[way])
    with ThreadPoolExecutor() as pool:
        found = pool.submit(came, reader)
        inside = WAITS if reader._ring else "TimedQueue.take"
        wait_until(lambda: runs(inside))
        getattr(reader, end)()
        assert found.result(HANG) == -1
    assert came(reader, wait=False) == -1


def test_a_session_that_is_closed(make: Make) -> None:
    reader = make()
    with ThreadPoolExecutor() as pool:
        found = pool.submit(came, reader)
        wait_until(lambda: runs(WAITS))
        reader.participant.session.close()
        assert found.result(HANG) == -1
    assert reader.ended()
    assert came(make(), wait=False) == 0  # others open another


def test_of_one_process_one_has_the_ring(make: Make) -> None:
    """What wakes its reader is nothing for the others, and pushes nothing out."""
    first, second = make(Qos(depth=1)), make(Qos(depth=1))
    assert first._ring is not None and second._ring is None
    put(first.participant, 1)
    for one in (first, second):
        one.limit_waiting(0.01)
    assert came(first) == 1
    for _ in range(10):
        assert came(first) == 0
    assert (came(second), came(second)) == (1, 0)
    assert second.dropped == 0
    first.close()
    third = make()
    assert third._ring is not None
    put(third.participant, 2)
    assert (came(second), came(third)) == (2, 2)


def test_what_lyrical_sends_beside_the_topic(make: Make) -> None:
    reader = make(type_=PICTURE)
    with ThreadPoolExecutor() as pool:
        found = pool.submit(came, reader)
        wait_until(lambda: runs(WAITS))
        put(reader.participant, 1, type_=PICTURE, beside=BESIDE)
        assert found.result(HANG) == 1
    put(reader.participant, 2, type_=PICTURE, beside=BESIDE)
    put(reader.participant, 3, type_=PICTURE)
    assert sorted(all_that_came(reader)) == [2, 3]


def test_the_type_is_known_later(make: Make) -> None:
    reader = make(type_="")
    with ThreadPoolExecutor() as pool:
        found = pool.submit(came, reader)
        wait_until(lambda: runs("TimedQueue.take"))
        with yarpy.Port("/out") as out:
            out.connect(f"ros2:/{NAME}~{TEXT}")
            wait_until(lambda: runs(WAITS))
        put(reader.participant, 1)
        assert found.result(HANG) == 1
    assert all_that_came(reader) == []


@pytest.mark.parametrize("waits", [False, True], ids=["read later", "read at once"])
def test_what_was_in_the_ring_comes_before_what_was_kept(make: Make, waits: bool) -> None:
    """When a publisher comes that keeps messages, nothing is lost, or comes twice."""
    reader = make()
    part, found = reader.participant, []
    done = threading.Event()

    def read() -> None:
        while not found or found[-1] != 9:
            found.append(came(reader))
        done.set()

    thread = threading.Thread(target=read)
    if waits:
        thread.start()
        wait_until(lambda: runs(WAITS))
    put(part, 1, 2, 3)
    reader._catch_up()
    assert reader._ring is None and reader._held is None
    put(part, 4, 9)
    if not waits:
        thread.start()
    assert done.wait(HANG)
    thread.join()
    assert found == [1, 2, 3, 4, 9]
    assert reader.dropped == 4
    put(part, 9, 10)
    assert all_that_came(reader) == [10]


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix: Windows has no pthread_kill")
def test_a_signal_handler_ends_the_wait_of_the_main_thread(make: Make) -> None:
    class Enough(Exception):
        pass

    def handler() -> None:
        raise Enough

    reader = make()
    with signalled(WAITS, signal.SIGUSR1, handler), pytest.raises(Enough):
        reader.receive()
    put(reader.participant, 1)
    assert came(reader) == 1


def test_a_port_that_is_closed_by_its_callback(names: yarpy.LocalNames) -> None:
    closed = threading.Event()

    def heard(message: yarpy.Message) -> None:
        reader.close()
        closed.set()

    with yarpy.Port("/out") as out:
        out.connect(f"ros2:/{NAME}~{TEXT}")
        reader = yarpy.Port("/in", callback=heard)
        reader.listen_to(f"ros2:/{NAME}~{TEXT}")
        out.write("x")
        assert closed.wait(HANG)
    wait_until(lambda: not runs(WAITS))
