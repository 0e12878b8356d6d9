"""The quality of service of topics over DDS, with a program of another kind: who hears whom, in any
order of arrival, and that nothing is lost without being counted."""

from __future__ import annotations

import contextlib
import itertools
import threading
import time

import pytest
from support.dds_program import Peer
from support.lasted import lasted
from support.wait import HANG, inside, wait_until

import yarpy
from yarpy.peers.ros2.dds import endpoint as module
from yarpy.peers.ros2.dds.endpoint import DdsPublisher

RELIABILITY = ("reliable", "best_effort")
DURABILITY = ("volatile", "transient_local")
ORDER = ("yarpy first", "yarpy last")
TYPE = "~std_msgs/msg/String"
_numbers = itertools.count()


def read_all(reader: yarpy.BufferedPort, until: str) -> list[str]:
    """What comes, up to a certain text."""
    found: list[str] = []
    while not found or found[-1] != until:
        found.append(reader.read(timeout=HANG).value)  # type: ignore[arg-type]
    return found


def say_until_read(peer: Peer, name: str, reader: yarpy.BufferedPort) -> None:
    """Write until the port has heard what was written last, so that nothing of that writer is on
    its way any more; what is heard of others meanwhile is thrown away."""
    for count in itertools.count():
        assert count < 20 * HANG, f"nothing of {name} came"
        text = f"{name} {next(_numbers)}"
        peer.do("write", name, text)
        try:
            while reader.read(timeout=0.05).value != text:
                pass
            return
        except yarpy.Timeout:
            continue


def write_until_heard(out: yarpy.Port, peer: Peer, *names: str) -> None:
    for _ in range(int(20 * HANG)):
        text = f"live {next(_numbers)}"
        out.write(text)
        with contextlib.suppress(AssertionError):
            wait_until(lambda text=text: all(text in peer.heard(name) for name in names), 0.05)  # type: ignore[misc]
            return
    raise AssertionError(f"{[peer.heard(name)[-3:] for name in names]}")


# -- one of each ----------------------------------------------------------------------------------


@pytest.mark.parametrize(  # who comes first has to name the type
    ("order", "typed"), [("yarpy first", True), ("yarpy last", True), ("yarpy last", False)]
)
@pytest.mark.parametrize("durability", DURABILITY)
@pytest.mark.parametrize("reliability", RELIABILITY)
def test_a_subscriber_hears_any_publisher(
    peer: Peer, topic: str, reliability: str, durability: str, order: str, typed: bool
) -> None:
    target = f"ros2+dds:/{topic}{TYPE if typed else ''}"
    name = f"w{topic}"
    with yarpy.BufferedPort("/in", strict=True) as reader:
        if order == "yarpy first":
            reader.listen_to(target)
        peer.do("writer", name, topic, reliability, durability, 5)
        peer.do("write", name, *(f"before {number}" for number in range(8)))
        if order == "yarpy last":
            reader.listen_to(target, timeout=HANG)
        if durability == "transient_local" and reliability == "reliable":
            found = read_all(reader, "before 7")
            assert found[-5:] == [f"before {number}" for number in range(3, 8)]
            assert len(found) == len(set(found))
        say_until_read(peer, name, reader)
        wait_until(lambda: peer.do("readers", topic) == [[reliability, durability]])
    wait_until(lambda: peer.do("readers", topic) == [], what="a closed port reads no longer")
    peer.do("close", name)


def test_a_publisher_that_is_found_late(
    peer: Peer, topic: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """DDS finds others by and by: who names no type waits for as long as the program says."""
    monkeypatch.setattr(module, "TIMEOUT", 0.0)
    name = f"w{topic}"

    def come() -> None:
        peer.do("writer", name, topic, "reliable", "volatile", 10)

    with yarpy.BufferedPort("/in", strict=True) as reader:
        coming = inside("DdsEndpoint.begin", come)
        reader.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        coming.join(HANG)
        say_until_read(peer, name, reader)
    peer.do("close", name)


def test_a_port_that_is_closed_looks_for_nobody(here: None, topic: str) -> None:
    with yarpy.BufferedPort("/in") as reader:
        closing, begun = inside("DdsEndpoint.begin", reader.close), time.monotonic()
        with pytest.raises(yarpy.PortClosed):
            reader.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        assert lasted(begun) < HANG / 2
        closing.join(HANG)


@pytest.mark.parametrize("qos", ["", "+qos.latched"])
@pytest.mark.parametrize("order", ORDER)
@pytest.mark.parametrize("durability", DURABILITY)
@pytest.mark.parametrize("reliability", RELIABILITY)
def test_any_subscriber_hears_a_publisher(
    peer: Peer, topic: str, reliability: str, durability: str, order: str, qos: str
) -> None:
    name = f"r{topic}"
    with yarpy.Port("/out") as out:
        if order == "yarpy last":
            peer.do("reader", name, topic, reliability, durability, 10)
        out.connect(f"ros2+dds{qos}:/{topic}{TYPE}")
        out.write("map")
        if order == "yarpy first":
            peer.do("reader", name, topic, reliability, durability, 10)
        if (qos, reliability, durability) == ("+qos.latched", "reliable", "transient_local"):
            wait_until(lambda: peer.heard(name) == ["map"])
        write_until_heard(out, peer, name)
    peer.do("close", name)


def test_the_first_message_reaches_who_asks_for_kept_ones(peer: Peer, topic: str) -> None:
    """Its writer comes after it, and is not waited for: nobody else hears the one before."""
    name = f"r{topic}"
    with yarpy.Port("/out") as out:
        out.connect(f"ros2+dds:/{topic}{TYPE}")
        peer.do("reader", name, topic, "reliable", "transient_local", 10)
        wait_until(lambda: peer.do("events", name)[0]["alive"] == 1)  # type: ignore[index]
        out.write("map")
        wait_until(lambda: peer.heard(name) == ["map"])
    peer.do("close", name)


def test_what_is_written_while_a_writer_is_made_is_heard(
    peer: Peer, topic: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its reader may know the new writer before we do; the one before is heard by nobody."""
    name, make = f"r{topic}", DdsPublisher._made
    writing: list[threading.Thread] = []

    def slow(publisher: DdsPublisher) -> object:
        made = make(publisher)
        if publisher.qos.latched:
            writing.append(threading.Thread(target=out.write, args=("map",)))
            writing[0].start()
            wait_until(lambda: peer.do("events", name)[0]["alive"] == 1)  # type: ignore[index]
            writing[0].join(0.3)
        return made

    monkeypatch.setattr(DdsPublisher, "_made", slow)
    with yarpy.Port("/out") as out:
        out.connect(f"ros2+dds:/{topic}{TYPE}")
        peer.do("reader", name, topic, "reliable", "transient_local", 10)
        wait_until(lambda: peer.heard(name) == ["map"])
        writing[0].join(HANG)
    peer.do("close", name)


# -- several --------------------------------------------------------------------------------------


@pytest.mark.parametrize("first", RELIABILITY)
def test_publishers_of_both_kinds_are_heard(peer: Peer, topic: str, first: str) -> None:
    second = next(other for other in RELIABILITY if other != first)
    one, two = f"one{topic}", f"two{topic}"
    peer.do("writer", one, topic, first, "volatile", 10)
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        say_until_read(peer, one, reader)
        peer.do("writer", two, topic, second, "volatile", 10)
        say_until_read(peer, two, reader)
        say_until_read(peer, one, reader)
        wait_until(lambda: peer.do("readers", topic) == [["best_effort", "volatile"]])
        peer.do("close", one if first == "best_effort" else two)
        left = two if first == "best_effort" else one

        def is_changed() -> bool:
            peer.do("write", left, "meanwhile")
            return peer.do("readers", topic) == [["reliable", "volatile"]]

        wait_until(is_changed)
        say_until_read(peer, left, reader)
        peer.do("close", left)


def test_a_reader_stays_until_its_successor_is_known(
    peer: Peer, topic: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Publishers hear of it some time later, and what they send until then would be lost."""
    monkeypatch.setattr(module, "CHANGING", 0.0)
    steady, other = f"steady{topic}", f"other{topic}"
    before, after = ["reliable", "volatile"], ["best_effort", "volatile"]
    peer.do("writer", steady, topic, "reliable", "volatile", 10)
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        say_until_read(peer, steady, reader)
        peer.do("writer", other, topic, "best_effort", "volatile", 10)
        wait_until(lambda: after in peer.do("readers", topic))
        say_until_read(peer, other, reader)
        assert sorted(peer.do("readers", topic)) == [after, before]  # type: ignore[type-var]
        say_until_read(peer, steady, reader)
        wait_until(lambda: peer.do("readers", topic) == [after])
    for name in (steady, other):
        peer.do("close", name)


def test_nothing_comes_twice_where_a_reader_takes_over(peer: Peer, topic: str) -> None:
    """A publisher by best effort comes and goes while a reliable one writes."""
    steady, other = f"steady{topic}", f"other{topic}"
    peer.do("writer", steady, topic, "reliable", "transient_local", 0)
    count = 0
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.listen_to(f"ros2+dds:/{topic}{TYPE}")
        say_until_read(peer, steady, reader)
        for _ in range(3):
            for wanted in ("best_effort", "reliable"):
                if wanted == "best_effort":
                    peer.do("writer", other, topic, "best_effort", "volatile", 1)
                else:
                    peer.do("close", other)
                while [wanted] != [row[0] for row in peer.do("readers", topic)]:  # type: ignore[index]
                    peer.do("write", steady, f"number {count}")
                    count += 1
        peer.do("write", steady, "end")
        found = [text for text in read_all(reader, "end") if text.startswith("number")]
    peer.do("close", steady)
    numbers = [int(text.split()[1]) for text in found]
    assert numbers == sorted(set(numbers))
    assert len(numbers) >= count - 6  # each takeover may lose one that is under way


def test_subscribers_of_both_kinds_hear_a_publisher(peer: Peer, topic: str) -> None:
    """The first one asks for little."""
    names = [f"{kind}{topic}" for kind in ("sensor", "rviz", "map")]
    peer.do("reader", names[0], topic, "best_effort", "volatile", 10)
    with yarpy.Port("/out") as out:
        out.connect(f"ros2+dds:/{topic}{TYPE}")
        write_until_heard(out, peer, names[0])
        peer.do("reader", names[1], topic, "reliable", "volatile", 10)
        write_until_heard(out, peer, *names[:2])
        peer.do("reader", names[2], topic, "reliable", "transient_local", 10)
        write_until_heard(out, peer, *names)
        out.write("end", wait=True)
        for name in names:
            wait_until(lambda name=name: "end" in peer.heard(name))  # type: ignore[misc]
            assert len(peer.heard(name)) == len(set(peer.heard(name)))
    for name in names:
        peer.do("close", name)


# -- how much is kept -----------------------------------------------------------------------------


def test_bursts_come_whole(peer: Peer, topic: str) -> None:
    """How much a publisher keeps DDS does not tell: ten are kept, as in ROS 2."""
    name = f"w{topic}"
    peer.do("writer", name, topic, "reliable", "volatile", 1)
    with yarpy.BufferedPort("/in", strict=True) as reader:
        reader.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        say_until_read(peer, name, reader)
        peer.do("close", name)
        peer.do("writer", name, topic, "reliable", "volatile", 10)
        say_until_read(peer, name, reader)
        for number in range(20):
            texts = [f"{number} {index}" for index in range(8)]
            peer.do("write", name, *texts)
            assert [reader.read(timeout=HANG).value for _ in texts] == texts
        assert reader.stats.inputs[0].drops == 0
    peer.do("close", name)


def test_what_a_slow_reader_misses_is_counted(peer: Peer, topic: str) -> None:
    name = f"w{topic}"
    held, free = threading.Event(), threading.Event()
    texts: list[str] = []

    def hear(message: yarpy.Message) -> None:
        if message.value == "hold":
            held.set()
            assert free.wait(HANG)
        elif str(message.value).startswith("number"):
            texts.append(str(message.value))

    peer.do("writer", name, topic, "reliable", "volatile", 0)
    with yarpy.Port("/in", callback=hear) as port:
        port.listen_to(f"ros2+dds:/{topic}", timeout=HANG)
        for _ in range(int(20 * HANG)):
            peer.do("write", name, "hold")
            if held.wait(0.05):
                break
        assert held.is_set()
        before = port.stats.inputs[0].drops
        peer.do("write", name, *(f"number {number}" for number in range(80)))
        free.set()
        wait_until(lambda: "number 79" in texts)
        assert texts == [f"number {number}" for number in range(70, 80)]
        assert port.stats.inputs[0].drops - before >= 70
    peer.do("close", name)
