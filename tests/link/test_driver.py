"""The driver: steps against a transport, and errors of the system as ours."""

from __future__ import annotations

import errno
import os
import socket
import threading
import time

import pytest
from support.port import free_port
from support.transport import ScriptTransport, scripted

from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.link.driver import Driver, link_error
from yarpy.transports.base import SocketTransport
from yarpy.transports.datagram import DatagramTransport
from yarpy.wire.effects import Group, Open, Switch
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, DatagramStream


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
        driver.run(steps(), time.monotonic() + 1)
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
    driver = Driver(SocketTransport(left))
    right.sendall(b"12")
    steps = driver.stream.read_exact(4)
    started = time.monotonic()
    with pytest.raises(Timeout):
        driver.run(steps, time.monotonic() + 0.05)
    assert time.monotonic() - started < 2
    right.sendall(b"34")
    assert driver.run(driver.stream.read_exact(4), time.monotonic() + 5) == b"1234"
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


# ---------------------------------------------------------------------------------- effects


def test_moving_to_another_place() -> None:
    """What was written goes out by the old way first; the old transport is closed."""
    driver, old = scripted(b"", open_ended=True)
    new = ScriptTransport([b"there"])
    fresh = ByteStream()

    def steps() -> Steps[bytes]:
        driver.stream.write(b"I move")
        yield Switch(new, fresh)
        return bytes((yield from fresh.read_exact(5)))

    assert driver.run(steps()) == b"there"
    assert old.said == b"I move"
    assert old.closed
    assert driver.transport is new
    assert driver.stream is fresh


def test_udp_is_opened_on_request() -> None:
    driver, _ = scripted(open_ended=True)

    def steps() -> Steps[int]:
        handle = yield Open("udp", listen=True)
        yield Switch(handle, DatagramStream())
        return int(handle.port)

    number = driver.run(steps())
    assert isinstance(driver.transport, DatagramTransport)
    assert 0 < number < 65536
    driver.transport.close()


def test_peer_is_dialled_once_more() -> None:
    """By somebody who wants to ask again, with what is left of the time."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        driver, old = scripted(open_ended=True)
        old.remote = listener.getsockname()

        def steps() -> Steps[bytes]:
            again = yield Open("tcp", listen=False)
            fresh = ByteStream()
            yield Switch(again, fresh)
            fresh.write(b"me again")
            return bytes((yield from fresh.read_exact(2)))

        def serve() -> None:
            sock, _ = listener.accept()
            assert sock.recv(8, socket.MSG_WAITALL) == b"me again"
            sock.sendall(b"ok")
            sock.close()

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        assert driver.run(steps(), time.monotonic() + 10) == b"ok"
        assert old.closed
        thread.join(5)
        driver.transport.close()


def test_peer_that_cannot_be_dialled_once_more() -> None:
    driver, transport = scripted(open_ended=True)
    transport.remote = ("127.0.0.1", free_port())

    def steps() -> Steps[None]:
        yield Open("tcp", listen=False)

    with pytest.raises(ConnectionRefusedError):
        driver.run(steps(), time.monotonic() + 10)
    assert driver.transport is transport  # for whoever opened it to close


def test_group_is_asked_for() -> None:
    transport = ScriptTransport()
    asked: list[str] = []

    def group(host: str) -> tuple[str, int]:
        asked.append(host)
        return "224.1.1.3", 21604

    def steps() -> Steps[tuple[str, int]]:
        found: tuple[str, int] = yield Group()
        return found

    assert Driver(transport, group=group).run(steps()) == ("224.1.1.3", 21604)
    assert asked == ["127.0.0.1"]
    with pytest.raises(LocalProtocolError, match="multicast"):
        Driver(transport).run(steps())


def test_what_cannot_be_done() -> None:
    driver, _ = scripted()

    def steps() -> Steps[None]:
        yield Open("carrier pigeon", listen=False)

    with pytest.raises(LocalProtocolError, match="pigeon"):
        driver.run(steps())


def test_limit_reaches_the_stream() -> None:
    transport = ScriptTransport([b"x" * 100])
    driver = Driver(transport, limit=1000)
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


def test_flush_by_a_deadline_leaves_the_rest_for_the_next() -> None:
    near, far = socket.socketpair()
    driver = Driver(SocketTransport(near))
    data = bytes(range(256)) * 20_000
    driver.stream.write(data)
    for deadline in (0.0, time.monotonic() + 0.05):
        with pytest.raises(Timeout):
            driver.flush(deadline)
    assert 0 < driver.bytes_out < len(data)
    assert driver.stream.pending
    driver.stream.write(b"the end")
    thread = threading.Thread(target=driver.flush, args=(time.monotonic() + 30,))
    thread.start()
    found = bytearray()
    while len(found) < len(data) + 7:
        found += far.recv(1 << 20)
    thread.join(5)
    assert bytes(found) == data + b"the end"
    assert driver.bytes_out == len(found)
    assert not driver.stream.pending
    near.close()
    far.close()
