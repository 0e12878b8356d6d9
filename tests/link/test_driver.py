"""The driver: steps against a transport, and errors of the system as ours."""

from __future__ import annotations

import errno
import os
import socket
import threading
import time

import pytest
from support.lasted import lasted
from support.transport import ScriptTransport, scripted
from support.wait import HANG

from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.link.begin.greeting import driver_of
from yarpy.link.driver import link_error
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire.effects import Switch
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


def test_steps_run_to_their_end() -> None:
    driver, transport = scripted(b"ab", b"cd")

    def steps() -> Steps[bytes]:
        driver.stream.write(b"hello")
        first = yield from driver.stream.read_exact(3)
        driver.stream.write(b"bye")
        return bytes(first)

    assert driver.run(steps()) == b"abc"
    assert transport.said == b"hellobye"
    assert driver.stream.waiting == 1
    assert (driver.bytes_in, driver.bytes_out) == (4, 8)


def test_what_was_written_leaves_before_waiting() -> None:
    """Otherwise both sides would wait."""
    driver, transport = scripted(b"x")
    seen: list[bytes] = []

    def steps() -> Steps[None]:
        driver.stream.write(b"question")
        yield None
        seen.append(transport.said)

    driver.run(steps())
    assert seen == [b"question"]


@pytest.mark.parametrize("listens", [True, False])
def test_last_words_to_a_peer_that_is_too_slow(listens: bool) -> None:
    driver, transport = scripted(BlockingIOError(11, "again"))

    def steps() -> Steps[None]:
        try:
            yield None
        except Timeout:
            driver.stream.write(b"too late")
            raise

    if not listens:

        def deaf(output: object) -> None:
            raise BrokenPipeError(32, "pipe")

        transport.send = deaf  # type: ignore[method-assign]
    with pytest.raises(Timeout):
        driver.run(steps(), time.monotonic() + 0.2)
    assert transport.said == (b"too late" if listens else b"")


def test_end_of_the_peer() -> None:
    driver, _ = scripted(b"123")
    with pytest.raises(LinkClosed, match="middle"):
        driver.run(driver.stream.read_exact(8))


@pytest.mark.parametrize(
    "error", [ConnectionResetError(104, "reset"), OSError(9, "bad"), BrokenPipeError(32, "pipe")]
)
def test_reset_is_an_end(error: OSError) -> None:
    driver, _ = scripted(error)
    with pytest.raises(LinkClosed):
        driver.run(driver.stream.read_exact(1))


def test_silence_is_a_timeout_and_what_came_is_kept() -> None:
    left, right = socket.socketpair()
    driver = driver_of(SocketTransport(left))
    right.sendall(b"12")
    steps = driver.stream.read_exact(4)
    started = time.monotonic()
    with pytest.raises(Timeout):
        driver.run(steps, time.monotonic() + 0.05)
    assert lasted(started) < 10
    right.sendall(b"34")
    assert driver.run(driver.stream.read_exact(4), time.monotonic() + HANG) == b"1234"
    # and the limit is gone: this waits as long as it takes
    threading.Timer(0.1, right.sendall, (b"5",)).start()
    assert driver.run(driver.stream.read_exact(1)) == b"5"
    left.close()
    right.close()


def test_deadline_that_has_passed() -> None:
    driver, _ = scripted(b"abc")
    with pytest.raises(Timeout):
        driver.run(driver.stream.read_exact(1), time.monotonic() - 1)


@pytest.mark.parametrize(
    ("error", "wanted"),
    [
        (BrokenPipeError(32, "Broken pipe"), LinkClosed),
        (ConnectionResetError(104, "Connection reset"), LinkClosed),
        (BlockingIOError(11, "again"), Timeout),
        (TimeoutError("timed out"), Timeout),
        (OSError(9, "Bad file descriptor"), LinkClosed),
        (LinkClosed("ours"), LinkClosed),
    ],
)
def test_errors_while_sending(error: OSError, wanted: type[Exception]) -> None:
    assert type(link_error(error)) is wanted


def test_failing_send_is_our_error() -> None:
    driver, transport = scripted(open_ended=True)
    transport.fails_after = 0
    driver.stream.write(b"x")
    with pytest.raises(LinkClosed, match="Broken pipe"):
        driver.flush()


def test_trying_takes_what_is_there() -> None:
    driver, _ = scripted(b"abc", open_ended=True)
    assert driver.try_fill()
    assert not driver.try_fill()
    assert driver.stream.waiting == 3
    ended, _ = scripted()
    assert ended.try_fill()
    with pytest.raises(LinkClosed):
        next(ended.stream.read_exact(1))


def test_what_belongs_to_a_greeting_is_not_done() -> None:
    """Nothing moves a connection on which messages go already."""
    driver, _ = scripted()

    def steps() -> Steps[None]:
        yield Switch(ScriptTransport(), ByteStream())

    with pytest.raises(LocalProtocolError, match="Switch"):
        driver.run(steps())


def test_limit_reaches_the_stream() -> None:
    transport = ScriptTransport([b"x" * 100])
    driver = driver_of(transport, limit=1000)
    with pytest.raises(RemoteProtocolError):
        driver.run(driver.stream.read_exact(20_000))


@pytest.mark.parametrize("number", [errno.ETIMEDOUT, errno.EHOSTUNREACH, errno.ENETUNREACH])
def test_dead_host_is_the_end_of_a_connection(number: int) -> None:
    """Not a peer that is merely late, who is not dialled again."""
    error = OSError(number, os.strerror(number))
    driver, _ = scripted(error)
    with pytest.raises(LinkClosed, match="host does not answer"):
        driver.fill()
    assert isinstance(link_error(error), LinkClosed)
