"""Writing: to many readers with one encoding, every message delivered or counted as a drop."""

from __future__ import annotations

import socket
import threading
import time
from contextlib import ExitStack

import pytest
from support.lasted import lasted
from support.system import NO_UNIX_SOCKETS
from support.wait import HANG, wait_until

from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.errors import PortClosed
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import BufferedPort, MessagePort, Port, envelope_of
from yarpy.wire.message import Message

ENVELOPES = [
    (Stamp(7, 1.25), b"7 1.25"),
    ("any text", b"any text"),
    (b"bytes", b"bytes"),
    ("cut\nhere", b"cut"),
    ("cut \u00e9 here", b"cut "),  # as C++, at the first byte that is not ASCII
    ("del\x7fete", b"del\x7fete"),
    ("", b""),
]


@pytest.mark.parametrize(("stamp", "wanted"), ENVELOPES)
def test_envelope_of_a_stamp_or_text(stamp: Stamp | str | bytes, wanted: bytes) -> None:
    assert envelope_of(stamp) == wanted


class Counting:
    """Something that knows how often it was encoded."""

    def __init__(self) -> None:
        self.encoded = 0

    def to_wire(self) -> tuple[bytes]:
        self.encoded += 1
        return (Bottle(["x"]).to_bytes(),)


@pytest.mark.parametrize("kind", [Port, BufferedPort])
def test_twenty_readers_cost_one_encoding(kind: type[MessagePort], names: LocalNames) -> None:
    local = "tcp" if NO_UNIX_SOCKETS else "unix_stream"
    carriers = ["tcp", "fast_tcp", "udp", "mcast", local] * 4
    heard: list[str] = []
    with kind("/out", names=names) as out, ExitStack() as stack:  # type: ignore[call-arg]
        for number, carrier in enumerate(carriers):
            name = f"/in{number}"
            in_ = stack.enter_context(
                Port(name, names=names, callback=lambda m, name=name: heard.append(name))
            )
            out.connect(name, carrier)
            assert in_.wait_for_inputs(timeout=HANG)
        thing = Counting()
        sent = out.write(thing)
        # of the multicast connections one sends for all
        assert sent == 17
        wait_until(lambda: len(heard) == 20)
        assert sorted(heard) == sorted(f"/in{number}" for number in range(20))
        assert thing.encoded == 1


def test_both_spellings_are_made_once(names: LocalNames) -> None:
    with Port("/out", names=names) as out, ExitStack() as stack:
        heard: list[Message] = []
        for number in range(6):
            name = f"/in{number}"
            stack.enter_context(Port(name, names=names, callback=heard.append))
            out.connect(name, "text" if number % 2 else "tcp")
        thing = Counting()
        out.write(thing)
        wait_until(lambda: len(heard) == 6)
        assert {m.spelling for m in heard} == {"text", "binary"}
        assert thing.encoded <= 2  # the text is read out of the binary spelling


# ---------------------------------------------------------------------------------- counting


class Heard:
    """What a reader got, in its own time."""

    def __init__(self, pause: float = 0.0) -> None:
        self.pause = pause
        self.count = 0

    def __call__(self, message: Message) -> None:
        self.count += 1
        time.sleep(self.pause)


MODES = [
    # writer, reader, carrier
    ("plain", "callback", "tcp"),
    ("plain", "callback", "fast_tcp"),
    ("plain", "callback", "text"),
    ("plain", "callback", "text_ack"),
    ("plain", "callback", "unix_stream"),
    ("plain", "callback", "unix_stream+ack"),
    ("plain", "callback", "local"),
    ("plain", "callback", "udp"),
    ("plain", "callback", "mcast"),
    ("plain", "callback", "name_ser"),
    ("plain", "latest", "tcp"),
    ("plain", "latest", "fast_tcp"),
    ("plain", "strict", "tcp"),
    ("plain", "plain", "tcp"),
    ("buffered", "callback", "tcp"),
    ("buffered", "latest", "tcp"),
    ("buffered", "latest", "fast_tcp"),
    ("buffered", "strict", "tcp"),
    ("strict", "latest", "tcp"),
    ("strict", "strict", "fast_tcp"),
]


@pytest.mark.parametrize(("writes", "reads", "carrier"), MODES)
def test_sent_is_delivered_and_drops(
    writes: str, reads: str, carrier: str, names: LocalNames
) -> None:
    """For every mode and on both sides: what was written was delivered or counted."""
    lossy = carrier in ("udp", "mcast")
    count = 400 if lossy else 1000
    heard = Heard()
    out = make("/out", writes, names, None)
    in_ = make("/in", reads, names, heard)
    with out, in_:
        out.connect("/in", carrier)
        first = 0
        if carrier == "name_ser":  # which says nothing before the first message
            first = out.write([0])
        assert in_.wait_for_inputs(timeout=HANG)
        done = threading.Event()
        reader = threading.Thread(target=read_all, args=(in_, heard, done))
        if reads != "callback":
            reader.start()
        for number in range(first, count):
            out.write([number])
            if lossy and number % 20 == 0:
                time.sleep(0.001)
        out.flush(timeout=HANG)
        sender = out.outputs[0]
        receiver = in_.inputs[0]
        wait_until(lambda: sender.stats.messages + left_out(sender) == count)
        # What comes late from a datagram counts as lost until the receiver has told.
        wait_until(lambda: heard.count + left_out(receiver) + left_out(sender) == count)
        done.set()
        in_.interrupt()
        if reads != "callback":
            reader.join(HANG)
        assert heard.count + left_out(receiver) + left_out(sender) == count
        if writes == "strict" or (writes == "plain" and not lossy):
            assert left_out(sender) == 0
        if reads in ("strict", "callback", "plain") and not lossy:
            assert left_out(receiver) == 0


def left_out(connection: object) -> int:
    """What this side did not pass on: what newer messages replaced, and what was lost."""
    stats = connection.stats  # type: ignore[attr-defined]
    return int(stats.replaced + stats.drops)


def make(name: str, mode: str, names: LocalNames, callback: Heard | None) -> Port | BufferedPort:
    if mode == "callback":
        return Port(name, names=names, callback=callback)
    if mode == "plain":
        return Port(name, names=names)
    return BufferedPort(name, strict=mode == "strict", names=names)


def read_all(port: Port | BufferedPort, heard: Heard, done: threading.Event) -> None:
    try:
        for message in port:
            heard(message)
    except PortClosed:
        pass


def test_what_a_slow_reader_misses_is_counted_where_it_was_left_out(names: LocalNames) -> None:
    with BufferedPort("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        for number in range(100):
            out.write([number])
            time.sleep(0.0005)
        stats = out.outputs[0].stats
        assert stats.replaced > 50  # the reader has not taken the first one yet
        assert stats.messages + stats.replaced == 100
        assert in_.read(timeout=HANG).value == [0]
        assert in_.inputs[0].stats.drops == 0


def test_reader_that_dies_is_counted_and_forgotten(names: LocalNames) -> None:
    """A bare socket that greets, reads nothing and goes."""
    with Port("/out", names=names) as out:
        sock = socket.create_connection(("127.0.0.1", out.contact.port), 5)
        sock.sendall(b"CONNECT reader\r\nr\r\n")
        assert out.wait_for_outputs(timeout=HANG)
        link = out._hub.outputs.links[0]
        sock.close()
        written = 0
        deadline = time.monotonic() + HANG
        while out.outputs and time.monotonic() < deadline:
            out.write([written])
            written += 1
        assert out.outputs == []
        # The last one may have been written when nobody was connected any more.
        assert link.counter.messages + link.counter.drops in (written - 1, written)
        assert out.write([1]) == 0


# ---------------------------------------------------------------------------------- waiting


def test_wait_means_taken_by_every_reader_that_acknowledges(names: LocalNames) -> None:
    slow = Heard(pause=0.05)
    with (
        Port("/out", names=names) as out,
        Port("/in", names=names, callback=slow),
        Port("/other", names=names, callback=Heard()),
    ):
        out.connect("/in")
        out.connect("/other", "fast_tcp")
        started = time.monotonic()
        assert out.write([1], wait=True) == 2
        assert time.monotonic() - started >= 0.05
        assert slow.count == 1


def test_flush_waits_for_what_was_written(names: LocalNames) -> None:
    slow = Heard(pause=0.02)
    with Port("/out", names=names) as out, Port("/in", names=names, callback=slow):
        out.connect("/in")
        for number in range(5):
            out.write([number])
        assert out.flush(timeout=HANG)
        assert slow.count == 5
        assert out.flush(timeout=HANG)  # nothing left


def test_flush_has_a_limit(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        out.write([1])
        started = time.monotonic()
        assert not out.flush(timeout=0.05)
        assert lasted(started) < 10
        assert in_.read(timeout=HANG).value == [1]
        assert out.flush(timeout=HANG)


def test_value_may_be_changed_after_writing(names: LocalNames) -> None:
    """Also in a burst, where messages are gathered into one send."""
    with Port("/out", names=names) as out, BufferedPort("/in", strict=True, names=names) as in_:
        out.connect("/in", "fast_tcp")
        blob = bytearray(100)
        for number in range(200):
            blob[:] = bytes([number]) * 100
            out.write([blob])
        found = [in_.read(timeout=HANG).value[0] for _ in range(200)]
        assert found == [bytes([number]) * 100 for number in range(200)]


def test_writer_to_a_stuck_reader_can_be_closed(names: LocalNames) -> None:
    """A reader that takes nothing must not keep the port, or the writing thread, for ever."""
    with Port("/out", names=names) as out:
        sock = socket.create_connection(("127.0.0.1", out.contact.port), 5)
        sock.sendall(b"CONNECT stuck\r\nr\r\n")
        assert out.wait_for_outputs(timeout=HANG)

        def write() -> None:
            for _ in range(10):
                try:
                    out.write(["x" * 5_000_000])
                except PortClosed:
                    return

        thread = threading.Thread(target=write)
        thread.start()
        time.sleep(0.2)
        started = time.monotonic()
        out.close()
        assert lasted(started) < 10
        thread.join(HANG)
        assert not thread.is_alive()
        sock.close()


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text", "text_ack", "udp", "unix_stream"])
def test_what_was_written_before_a_goodbye_arrives(carrier: str, names: LocalNames) -> None:
    """Over text a sender that hung up used to take back what the reader had not read yet."""
    count = 1000 if carrier == "udp" else 3000  # a kernel holds so many datagrams
    with (
        Port("/out", names=names) as out,
        BufferedPort("/in", strict=True, names=names) as in_,
    ):
        out.connect("/in", carrier)
        for number in range(count):
            out.write([number, "x" * 1000])
        out.disconnect("/in")
        got = [in_.read(timeout=HANG).value[0] for _ in range(count)]
        assert got == list(range(count))


@pytest.mark.parametrize("stamp", [5, 1.5, [1, 2], object])
def test_stamp_that_is_none_is_told_so_even_when_nobody_listens(
    stamp: object, names: LocalNames
) -> None:
    """`write([1], 5)`, where `write([1, 5])` was meant."""
    with Port("/out", names=names) as port, pytest.raises(TypeError, match=r"write\(\[1, 2\]\)"):
        port.write([1], stamp)  # type: ignore[arg-type]
