"""The reader: from the mailbox or straight from the socket, and nobody notices which."""

from __future__ import annotations

import threading
import time

import pytest
from support.wait import wait_until

from yarpy import network
from yarpy.errors import PortClosed, Timeout
from yarpy.names.local import LocalNames
from yarpy.port.buffered import BufferedPort
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Message

KINDS = ["plain", "strict", "latest", "spinning"]


def make(kind: str, names: LocalNames) -> Port | BufferedPort:
    if kind in ("plain", "spinning"):
        return Port("/in", names=names, spin=kind == "spinning")
    return BufferedPort("/in", strict=kind == "strict", names=names)


@pytest.mark.parametrize("kind", KINDS)
def test_ping_pong_then_pause_then_ping_pong(kind: str, names: LocalNames) -> None:
    """A quick reader takes the turn, stays away, and comes back: nothing is lost or twice."""
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        number = 0
        for pause in (0, 0.08, 0, 0.012, 0):
            for _ in range(50):
                out.write([number])
                assert in_.read(timeout=5).value == [number]
                number += 1
            time.sleep(pause)
        assert in_.inputs[0].stats["messages"] == number
        assert in_.inputs[0].stats["drops"] == 0
        assert len(in_.inputs) == 1


@pytest.mark.parametrize("kind", KINDS)
def test_silence_is_no_failure(kind: str, names: LocalNames) -> None:
    """Time limits of a reader that took the turn do not stay with the connection."""
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=5)
        for _ in range(3):
            with pytest.raises(Timeout):
                in_.read(timeout=0.01)
        time.sleep(0.15)
        assert len(in_.inputs) == 1
        out.write(["after"])
        assert in_.read(timeout=5).value == ["after"]


@pytest.mark.parametrize("kind", KINDS)
def test_time_limit_is_kept_with_the_turn(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=5)
        for limit in (0, 0.005, 0.05, 0.15):
            started = time.monotonic()
            with pytest.raises(Timeout):
                in_.read(timeout=limit)
            assert limit - 0.002 <= time.monotonic() - started < limit + 0.5


@pytest.mark.parametrize("kind", KINDS)
def test_interrupt_wakes_a_reader_with_the_turn(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=5)
        threading.Timer(0.05, in_.interrupt).start()
        started = time.monotonic()
        with pytest.raises(PortClosed):
            in_.read()
        assert time.monotonic() - started < 2
        in_.resume()
        out.write(["after"])
        assert in_.read(timeout=5).value == ["after"]


@pytest.mark.parametrize("kind", KINDS)
def test_second_connection_while_a_reader_has_the_turn(kind: str, names: LocalNames) -> None:
    with (
        make(kind, names) as in_,
        Port("/out", names=names) as out,
        Port("/other", names=names) as other,
    ):
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=5)
        found: list[Message] = []
        reader = threading.Thread(target=lambda: found.append(in_.read(timeout=5)))
        reader.start()
        time.sleep(0.02)
        other.connect("/in")
        other.write(["hello"])
        reader.join(5)
        assert found[0].value == ["hello"]
        assert found[0].source == "/other"
        out.write(["again"])
        assert in_.read(timeout=5).value == ["again"]


@pytest.mark.parametrize("kind", KINDS)
def test_port_can_be_asked_while_a_reader_has_the_turn(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=5)
        found: list[Message] = []
        reader = threading.Thread(target=lambda: found.append(in_.read(timeout=5)))
        reader.start()
        assert network.is_connected("/out", "/in", names=names)
        assert network.exists("/in", names=names)
        out.write(["after"])
        reader.join(5)
        assert found[0].value == ["after"]


@pytest.mark.parametrize("kind", ["plain", "spinning"])
def test_questions_with_the_turn(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, RpcClient("/in", names=names) as client:

        def serve() -> None:
            for number, message in enumerate(in_):
                if number % 10 == 9:
                    continue  # left open: the next read closes it
                message.reply([number])

        threading.Thread(target=serve, daemon=True).start()
        answers = [client.call("x", timeout=5) for _ in range(40)]
        assert answers == [[] if n % 10 == 9 else [n] for n in range(40)]


@pytest.mark.parametrize("kind", KINDS)
def test_sender_disconnects_while_a_reader_has_the_turn(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        for _ in range(3):
            out.connect("/in")
            for number in range(20):
                out.write([number])
                assert in_.read(timeout=5).value == [number]
            assert out.disconnect("/in")
            with pytest.raises(Timeout):
                in_.read(timeout=0.02)
            wait_until(lambda: not in_.inputs)


def test_latest_skips_while_its_reader_is_away(names: LocalNames) -> None:
    with BufferedPort("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(30):
            out.write([number])
            in_.read(timeout=5)
        time.sleep(0.05)
        for number in range(10):
            out.write([number], wait=True)
        assert in_.read(timeout=5).value == [9]
        assert in_.inputs[0].stats["drops"] == 9


def test_latest_is_the_newest_for_a_reader_that_works_between_messages(names: LocalNames) -> None:
    """Two milliseconds of work are not enough for the link's thread to take over by itself."""
    with BufferedPort("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        number = newest = 0
        for _ in range(50):
            for _ in range(3):
                number += 1
                out.write([number])
            time.sleep(0.002)
            newest += in_.read(timeout=5).value == [number]
        assert newest >= 40


def test_polling_while_the_turn_is_out(names: LocalNames) -> None:
    """Who polls instead of reading gets what comes, a moment later at most."""
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(30):
            out.write([number])
            in_.read(timeout=5)
        for number in range(5):
            out.write([number])
            found: list[Message] = []
            wait_until(lambda found=found: found.extend(filter(None, [in_.poll()])) or found)
            assert found[0].value == [number]


def test_strict_port_counts_what_waits(names: LocalNames) -> None:
    with BufferedPort("/in", strict=True, names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(10):
            out.write([number], wait=True)
        assert in_.waiting == 10
        in_.read(timeout=5)
        assert in_.waiting == 9
