"""Write deadlines: who does not read keeps his writer waiting for a time, and nobody else."""

from __future__ import annotations

import logging
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import closing

import numpy as np
import pytest
from support.patience import patience
from support.wait import wait_until

import yarpy
from yarpy.link import outbound
from yarpy.link.write_timeout import STRANGERS
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import MessagePort

BIG = "x" * 3_000_000  # more than the kernel takes for a reader that does not read

REQUESTS = {
    "text": b"CONNECT stuck\r\nr\r\n",
    "mjpeg": b"GET /?action=stream HTTP/1.0\r\n\r\n",
    "events": b"GET /r HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n\r\n",
    "websocket": (
        b"GET /?ws&read HTTP/1.1\r\nHost: h\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
    ),
}


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> float:
    """Strangers are waited for half a second."""
    monkeypatch.setattr(outbound, "STRANGERS", 0.5)
    return 0.5


def stranger(port: MessagePort, request: bytes, room: int = 4096) -> socket.socket:
    """Somebody who asked to read, and does not."""
    before = len(port.outputs)
    sock = socket.socket()
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    sock.connect(("127.0.0.1", port.contact.port))
    sock.sendall(request)
    assert port.wait_for_outputs(before + 1, timeout=5)
    return sock


def test_ten_seconds_for_strangers() -> None:
    assert STRANGERS == 10.0


@pytest.mark.parametrize("kind", [yarpy.Port, yarpy.BufferedPort])
def test_stranger_that_stops_reading_is_cut_and_counted(
    kind: type[MessagePort],
    short: float,
    names: LocalNames,
    caplog: pytest.LogCaptureFixture,
) -> None:
    with (
        caplog.at_level(logging.WARNING, "yarpy"),
        kind("/out", names=names) as out,  # type: ignore[call-arg]
        closing(stranger(out, REQUESTS["text"])),
    ):
        written = 0
        until = time.monotonic() + patience(20.0)
        while out.outputs and time.monotonic() < until:
            out.write([BIG])
            written += 1
            time.sleep(0.01)
        assert not out.outputs
        past = out.stats["past"]["outputs"]
        counted = past["messages"] + past["drops"] + past["unconfirmed"]
        assert counted + out.stats["unconnected"] == written
        assert past["drops"]
        assert caplog.text.count("does not read") == 1


@pytest.mark.parametrize("request_", ["mjpeg", "events", "websocket"])
def test_pages_that_take_nothing_are_cut_too(
    request_: str, short: float, names: LocalNames
) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (1000, 1000, 3), np.uint8)
    value = noise if request_ == "mjpeg" else [BIG]
    with (
        yarpy.Port("/out", names=names) as out,
        closing(stranger(out, REQUESTS[request_])),
    ):
        until = time.monotonic() + patience(30.0)
        longest = 0.0
        while out.outputs and time.monotonic() < until:
            out.write(value)
            started = time.monotonic()
            out.write([1])
            longest = max(longest, time.monotonic() - started)
            time.sleep(0.05)
        assert not out.outputs
        assert longest < short  # they never held the writer up


def test_stranger_that_reads_slowly_stays(short: float, names: LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        closing(stranger(out, REQUESTS["text"], 1 << 20)) as sock,
    ):
        ended = threading.Event()

        def read() -> None:
            while not ended.wait(0.01):
                sock.recv(100_000)

        thread = threading.Thread(target=read)
        thread.start()
        started = time.monotonic()
        while time.monotonic() < started + 4 * short:
            assert out.write(["x" * 300_000]) == 1
        assert out.outputs
        ended.set()
        thread.join(5)


# ---------------------------------------------------------------------------------- siblings


@pytest.fixture
def stuck(names: LocalNames) -> Iterator[yarpy.Port]:
    """A port that nobody reads."""
    with yarpy.Port("/a_stuck", names=names) as port:
        yield port


@pytest.mark.parametrize("payload", ["x" * 20_000, BIG])
@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text"])
def test_siblings_of_a_stopped_reader_get_what_is_written(
    carrier: str, payload: str, names: LocalNames, stuck: yarpy.Port
) -> None:
    """Though it was connected first, and its writer waits for it."""
    heard: list[int] = []
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.Port("/b", names=names, callback=lambda m: heard.append(m.value[0])),
        yarpy.Port("/c", names=names, callback=lambda m: heard.append(m.value[0])),
    ):
        for name in ("/a_stuck", "/b", "/c"):
            out.connect(name, carrier)
        written: list[int] = []

        def write() -> None:
            for number in range(100_000):
                written.append(number)
                out.write([number, payload])

        thread = threading.Thread(target=lambda: _until_closed(write))
        thread.start()
        last = -1
        until = time.monotonic() + patience(20.0)
        while time.monotonic() < until:  # until the writer stands still
            time.sleep(0.5)
            if written and written[-1] == last:
                break
            last = written[-1]
        assert written[-1] == last
        wait_until(lambda: heard.count(last) == 2)
        assert sorted(heard) == sorted([*range(last + 1)] * 2)
        out.interrupt()
        stuck.close()
        thread.join(patience(10.0))
        assert not thread.is_alive()


def _until_closed(write: object) -> None:
    try:
        write()  # type: ignore[operator]
    except yarpy.PortClosed:
        pass


# ---------------------------------------------------------------------------------- timeout=


@pytest.mark.parametrize("strict", [None, True])
@pytest.mark.parametrize("siblings", [0, 1])
@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp"])
def test_write_with_a_timeout_drops_and_counts(
    strict: bool | None, siblings: int, carrier: str, names: LocalNames, stuck: yarpy.Port
) -> None:
    heard: list[int] = []
    with (
        yarpy.Port("/out", names=names)
        if strict is None
        else yarpy.BufferedPort("/out", strict=strict, names=names) as out,
        yarpy.Port("/b", names=names, callback=lambda m: heard.append(m.value[0])),
    ):
        out.connect("/a_stuck", carrier)
        if siblings:
            out.connect("/b", carrier)
        found = []
        for number in range(12):
            started = time.monotonic()
            found.append(out.write([number, BIG], timeout=0.1))
            assert time.monotonic() - started < patience(2.0)
        assert found[0] == 1 + siblings
        assert found[-1] == siblings
        stats = next(o.stats for o in out.outputs if o.target == "/a_stuck")
        assert stats["messages"] + stats["drops"] == 12
        assert stats["drops"] == found.count(siblings)
        assert stats["messages"]
        if siblings:
            wait_until(lambda: heard == [*range(12)])


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "unix_stream"])
def test_message_that_was_halfway_arrives_as_it_was_written(
    carrier: str, names: LocalNames
) -> None:
    """Whatever becomes of the array when `write` has returned, and though nothing is written
    after it."""
    image = np.full((3000, 3000), 7, np.uint8)
    with yarpy.Port("/out", names=names) as out, yarpy.Port("/in", names=names) as in_:
        out.connect("/in", carrier)
        taken = 0
        for number in range(10):
            image[:] = number
            took = out.write(image, timeout=0.2)
            image[:] = 255
            if not took:
                break
            taken += 1
        assert 1 <= taken < 10
        for number in range(taken):
            array = in_.read(timeout=5).value.array
            assert array.min() == array.max() == number
        assert out.write(["next"]) == 1
        assert in_.read(timeout=5).value == ["next"]
        assert out.outputs[0].stats["drops"] == 1


def test_timeout_and_wait(names: LocalNames, stuck: yarpy.Port) -> None:
    """Who has not taken the message by then is not among those that are told of."""
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.Port("/b", names=names, callback=lambda m: None),
    ):
        out.connect("/a_stuck")
        out.connect("/b")
        assert out.write([1], wait=True, timeout=0.2) == 1
        assert len(out.outputs) == 2
        assert stuck.read(timeout=5).value == [1]
        assert out.flush(timeout=5)
        assert all(o.stats["drops"] == 0 for o in out.outputs)


@pytest.mark.skipif(sys.platform != "linux", reason="an option of Linux")
def test_answer_that_nobody_takes_ends_its_connection(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARPY_PEER_TIMEOUT", "1")
    with (
        yarpy.RpcServer("/server", lambda message: [BIG, BIG, BIG], names=names) as server,
        closing(socket.create_connection(("127.0.0.1", server.contact.port))) as sock,
    ):
        sock.sendall(b"CONNACK /asker\r\nd\r\nask\r\n")
        assert server.wait_for_inputs(1, timeout=5)
        wait_until(lambda: not server.inputs, patience(20.0))
