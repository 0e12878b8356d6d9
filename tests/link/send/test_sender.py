"""Messages on the wire: gathered, ahead of their acknowledgements, and all accounted for."""

from __future__ import annotations

import select
import socket
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial

import pytest
from support.build import replaces_a_method
from support.capture import load_capture
from support.moments import moments
from support.outbound import at_work, connected, link_on, open_link, read_messages, total
from support.transport import scripted
from support.wait import HANG, wait_until

from yarpy.carriers.base import Carrier
from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.carriers.own.text import Text
from yarpy.carriers.own.unix_stream import UnixStream
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed
from yarpy.link.ending import moment
from yarpy.link.send.flusher import GATHER_SECONDS
from yarpy.link.send.sender import BURST, LASTING, Sender
from yarpy.wire import framing
from yarpy.wire.message import Packet

ACK = framing.ACK


def test_golden_stream() -> None:
    """What the link sends from the first message to the goodbye is what C++ sent."""
    capture = load_capture("conn_tcp_stream_envelope")
    said = b"".join(s.data for s in capture.steps[2:] if s.sender == "a")
    acks = b"".join(s.data for s in capture.steps[2:] if s.sender == "b")
    link, transport = open_link(Tcp, acks)
    nested = [["a", [1, 2]], [1.5, "x y"]]
    for envelope, value in (
        (b"1 0.25", []),
        (b"2 1.25", [1, "ping", 3.14]),
        (b"3 2.25", [*nested, Vocab("set")]),
    ):
        link.send(Packet(value, envelope))
    link.close()
    assert transport.said == said
    assert transport.closed
    assert link.counter.messages == 3
    assert link.counter.drops == 0


def test_messages_and_bytes_are_counted() -> None:
    link, transport = open_link(FastTcp)
    for number in range(10):
        link.send(Packet([number]))
        time.sleep(0.0005)
    assert link.counter.messages == 10
    assert link.counter.bytes == len(transport.said)
    assert link.snapshot()["messages"] == 10


def test_burst_is_gathered_and_nothing_is_left_behind() -> None:
    """The first messages leave at once; a flood shares its sends; a timer sends the rest."""
    link, transport = open_link(FastTcp)
    count = 2000
    for number in range(count):
        link.send(Packet([number]))
    size = len(b"".join(framing.encode(Packet([0]))))  # type: ignore[arg-type]
    wait_until(lambda: len(transport.said) == count * size)
    assert transport.sends < count
    assert link.counter.messages == count
    assert link.wait_sent() and link.counter.bytes == count * size
    link.close()


@replaces_a_method
def test_the_flusher_leaves_the_processor_to_the_thread_that_sends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tries: list[bool] = []
    drain = Sender.drain

    def tried(sender: Sender, *limits: object) -> bool:
        tries.append(drain(sender, *limits))  # type: ignore[arg-type]
        return tries[-1]

    monkeypatch.setattr(Sender, "drain", tried)
    link, _ = open_link(FastTcp)
    began = time.monotonic()
    with link.sender.lock:
        while not link.sender.gathered:
            link.sender.transmit(Packet([1]), None)
        wait_until(lambda: tries)
        time.sleep(0.05)
        assert not any(tries) and len(tries) <= (time.monotonic() - began) / GATHER_SECONDS + 1
    wait_until(lambda: tries[-1])
    link.close()


def test_the_flusher_sleeps_while_messages_leave_one_by_one() -> None:
    link, _ = open_link(FastTcp)
    sender = link.sender
    sender._gathered_since = time.perf_counter() - 1.0
    link.send(Packet([1]))
    assert not sender._drain_all()
    sender._gathered_since = time.perf_counter() + 1.0
    assert sender._drain_all()
    link.close()


@replaces_a_method
def test_who_says_that_more_follow_sends_them_together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Sender, "_watch", lambda sender: None)  # nobody else sends meanwhile
    link, transport = open_link(FastTcp)
    link.sender.more = True
    for number in range(10):
        assert link.send(Packet([number]))
    assert transport.sends == 0 and link.counter.messages == 10
    link.sender.more = False
    assert link.send(Packet([10]))
    assert transport.sends == 1
    assert transport.said == b"".join(bytes(framing.encode(Packet([n]))[0]) for n in range(11))


def test_a_send_takes_no_less_than_its_transport_says() -> None:
    """Most of it may be done in threads of others: then a writer floods that seems slower."""
    link, transport = open_link(FastTcp)
    transport.cost = 30.0  # type: ignore[attr-defined]
    sender = Sender(link.driver, link.carrier)
    for number in range(BURST):
        with sender.lock:
            sender.transmit(Packet([number]), None)
        time.sleep(0.001)
    assert sender._cost == 30.0 and transport.sends == BURST
    with sender.lock:
        sender.transmit(Packet([BURST]), None)
        sender.transmit(Packet([BURST]), None)
    assert sender._rush == BURST
    sender.give_up()
    link.close()


def test_flood_that_was_interrupted_goes_on_being_gathered() -> None:
    link, _ = open_link(FastTcp)
    sender = link.sender

    def rush_after(pause: float) -> int:
        """What is thought of a writer who was flooding and comes back after so many seconds."""
        sender._rush, sender._left = BURST, time.perf_counter() - pause
        link.send(Packet([1]))
        return sender._rush

    # A loaded machine may add to the pause, but not every time.
    assert any(rush_after(LASTING / 4) == BURST - 1 for _ in range(1000))
    assert rush_after(2 * LASTING) == 0
    link.close()


def test_value_that_cannot_be_sent_is_the_writers_error() -> None:
    link, transport = open_link(Tcp, ACK)
    with pytest.raises(TypeError, match="cannot be sent"):
        link.send(Packet(object()))
    assert not link.broken
    assert transport.said == b""
    link.send(Packet([1]))
    assert link.counter.messages == 1


@pytest.mark.parametrize("carrier", [Tcp, Text])
@pytest.mark.parametrize("error", [RuntimeError, KeyError, OSError, AssertionError])
def test_whatever_a_value_raises_is_the_writers_error(
    error: type[Exception], carrier: type[Carrier]
) -> None:
    class Value:
        def to_wire(self) -> tuple[bytes]:
            raise error("oh")

    link, transport = open_link(carrier, ACK)
    for value in (Value(), [1, Value()]):
        with pytest.raises(error, match="oh"):
            link.send(Packet(value))
    assert not link.broken
    assert transport.said == b""
    link.send(Packet([1]))
    assert link.counter.messages == 1


def test_large_buffers_are_sent_from_where_they_are() -> None:
    link, transport = open_link(FastTcp)
    pixels = bytearray(1 << 20)
    seen: list[bool] = []
    transport.send = lambda buffers: seen.append(  # type: ignore[method-assign]
        any(getattr(b, "obj", None) is pixels for b in buffers)
    )
    link.send(Packet([memoryview(pixels)]))
    assert seen == [True]


@pytest.mark.parametrize("sends", [0, 1, 5, 17])
@pytest.mark.parametrize("kind", [FastTcp, Tcp])
def test_sent_is_delivered_and_drops(kind: type[Carrier], sends: int) -> None:
    """Whatever number of sends succeed, no message is counted twice or not at all."""
    link, transport = open_link(kind)
    transport.fails_after = sends
    attempts = 0
    with pytest.raises(LinkClosed):
        for number in range(1000):
            attempts += 1
            link.send(Packet([number]))
    assert link.broken
    assert transport.closed
    assert total(link) == attempts
    assert 0 <= link.counter.messages <= sends
    if kind is Tcp:  # nothing was acknowledged, so nothing is known to have arrived
        assert link.counter.messages == 0
    with pytest.raises(LinkClosed):
        link.send(Packet(["more"]))
    assert total(link) == attempts + 1


@pytest.mark.parametrize("acks", [0, 1, 31, 32, 40, 64])
def test_what_was_acknowledged_counts_as_delivered(acks: int) -> None:
    """The peer takes some messages and goes."""
    link = link_on(scripted(ACK * acks), Tcp)
    attempts = 0
    with pytest.raises(LinkClosed):
        for number in range(1000):
            attempts += 1
            link.send(Packet([number]))
            if attempts % 50 == 0:
                link.wait_acknowledged(moment(1))
    assert link.counter.messages == acks
    assert total(link) == attempts


@replaces_a_method
def test_gathered_messages_that_had_just_left_when_a_signal_came_are_no_drops(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They were counted as dropped, and came."""
    link, _ = open_link(FastTcp)
    sender, attempts = link.sender, 0
    with sender.lock:  # no timer sends them
        while sender.gathered < 4:
            attempts += 1
            assert attempts < 1000
            sender.transmit(Packet([attempts]), None)
        push = link.driver.push

        def interrupted() -> bool:
            push()
            raise KeyboardInterrupt

        monkeypatch.setattr(link.driver, "push", interrupted)
        with pytest.raises(KeyboardInterrupt):
            sender.flush()
        sender.give_up()
    assert (link.counter.unconfirmed, link.counter.drops) == (attempts, 0)


def test_gathered_messages_that_never_left_are_drops() -> None:
    link, transport = open_link(FastTcp)
    attempts = 0
    with link.sender.lock:  # the timer waits for it
        for number in range(200):  # a flood: the last ones wait for the timer
            attempts += 1
            link.sender.transmit(Packet([number]), None)
            if link.sender.gathered > 3:
                break
        waiting = link.sender.gathered
        assert waiting
        sent = attempts - waiting
        transport.fails_after = transport.sends
    wait_until(lambda: link.broken)
    assert (link.counter.unconfirmed, link.counter.drops) == (sent, waiting)
    assert total(link) == attempts


def test_acknowledgements_that_came_before_the_end_count() -> None:
    """Nobody had looked at them when the connection broke."""
    for _ in range(20):  # on a busy machine so much time may pass that they are looked at
        link, transport = open_link(Tcp, ACK * 3)
        for number in range(5):
            link.send(Packet([number]))
        if link.sender.window.open == 5:
            break
    assert link.sender.window.open == 5
    transport.fails_after = transport.sends
    with pytest.raises(LinkClosed):
        link.send(Packet(["the end"]))
    counter = link.counter
    assert (counter.messages, counter.drops, counter.unconfirmed) == (3, 1, 2)


def test_acknowledgements_that_another_thread_reads_are_left_to_it() -> None:
    """The one that ends a connection waits for nobody: what it does not know is unconfirmed."""
    for _ in range(20):  # as above
        link, _ = open_link(Tcp, ACK * 3)
        for number in range(5):
            link.send(Packet([number]))
        if link.sender.window.open == 5:
            break
    with at_work(link):
        link.sender.give_up(at_rest=False)
    counter = link.counter
    assert (counter.messages, counter.drops, counter.unconfirmed) == (0, 0, 5)


@pytest.mark.parametrize("late", [0, 3])
def test_without_acknowledgements_the_system_of_a_dead_peer_is_not_believed(late: int) -> None:
    """It takes messages for a program that has ended, or that has them in its hands and ends."""
    with connected(FastTcp) as (link, far):
        for number in range(10):
            link.send(Packet([number]))
        link.sender.confirmation.told(10, 4)
        read_messages(far, 10, ack=False)
        far.close()
        wait_until(lambda: link.driver.transport.ended())
        for number in range(late):
            try:
                link.send(Packet([number]))
            except LinkClosed:
                break
        assert link.ended()
        counter = link.counter
        assert counter.messages == 4
        assert counter.unconfirmed + counter.drops in range(6 + min(late, 1), 6 + late + 1)


@pytest.mark.skipif(sys.platform != "linux", reason="the system does not tell")
@pytest.mark.parametrize("kind", [FastTcp, UnixStream])
def test_a_goodbye_without_acknowledgements_waits_until_the_peer_has_read_all(
    kind: type[Carrier],
) -> None:
    with connected(kind) as (link, far):
        for number in range(10):
            link.send(Packet([number]))
        thread = threading.Thread(target=link.close)
        thread.start()
        read_messages(far, 10, ack=False)
        assert not link.broken, "it waits for the end"
        while far.recv(1) != b"q":
            pass
        far.recv(100)
        far.close()
        thread.join(HANG)
        counter = link.counter
        assert (counter.messages, counter.drops, counter.unconfirmed) == (10, 0, 0)


@pytest.mark.skipif(sys.platform != "linux", reason="the system does not tell")
@pytest.mark.parametrize("kind", [FastTcp, UnixStream])
@pytest.mark.parametrize("said", [False, True])
def test_a_peer_that_hangs_up_before_it_has_read_all_leaves_doubt(
    kind: type[Carrier], said: bool
) -> None:
    with connected(kind) as (link, far):
        for number in range(10):
            link.send(Packet([number]))
        read_messages(far, 3, ack=False)
        if said:  # as a port does that closes: to the system, all is in good order
            far.shutdown(socket.SHUT_RDWR)
        far.close()
        link.close()
        counter = link.counter
        assert (counter.messages, counter.drops, counter.unconfirmed) == (0, 0, 10)


def test_without_acknowledgements_an_answer_tells_what_came() -> None:
    """The peer was reset with more to read: what it had not reported is open."""
    with connected(FastTcp) as (link, far):
        for number in range(10):
            link.send(Packet([number]))
        link.sender.confirmation.told(8, 6)
        assert link.snapshot()["unacknowledged"] == 4
        assert link.snapshot()["messages"] == 10
        select.select([far], [], [], 5)
        far.close()  # with everything unread
        wait_until(link.ended)
        counter = link.counter
        assert (counter.messages, counter.drops, counter.unconfirmed) == (6, 0, 4)


def test_interrupted_send_ends_the_connection_and_is_counted() -> None:
    """By Ctrl-C: half a message may be on its way, so another must not follow."""
    with connected() as (link, _):

        def interrupted(buffer: object, flags: int) -> int:
            raise KeyboardInterrupt

        link.driver._send = interrupted  # type: ignore[assignment]
        with pytest.raises(KeyboardInterrupt):
            link.send(Packet([1]))
        assert link.broken
        assert (link.counter.messages, link.counter.drops) == (0, 1)


def test_encoded_messages_leave_at_once() -> None:
    link, transport = open_link(FastTcp)
    assert link.send_whole(b"hello") and link.send_whole(b"there")
    assert transport.said == b"hellothere"
    assert (link.counter.messages, link.counter.bytes) == (2, 10)
    with at_work(link):
        assert not link.send_whole(b"in the way")
    link.driver.stream.write(b"first")
    assert not link.send_whole(b"second")
    assert transport.said == b"hellothere"
    waiting, transport = open_link(Tcp)
    assert not waiting.send_whole(b"who waits for acknowledgements?")
    assert transport.said == b""


def test_a_burst_leaves_in_one_piece_and_is_counted_by_message() -> None:
    link, transport = open_link(FastTcp)
    sends = []
    send = transport.try_send
    transport.try_send = lambda buffers: sends.append(1) or send(buffers)  # type: ignore[func-returns-value, method-assign]
    packets = [Packet(["a", "line"]), Packet(["b", "another"]), Packet(["c"])]
    assert link.send_burst(packets)
    frames = [b"".join(framing.encode(packet)) for packet in packets]
    assert (len(sends), transport.said) == (1, b"".join(frames))
    assert link.counter.messages == 3
    first, second, third = map(len, frames)
    assert [*link.sender.confirmation.ends] == [first, first + second, first + second + third]
    assert not link.send_burst([])
    waiting, transport = open_link(Tcp)
    assert not waiting.send_burst(packets), "each of them is acknowledged"
    assert transport.said == b""


def test_the_rest_of_an_encoded_message_follows() -> None:
    """Nothing is begun where the reader takes nothing; the rest of what has begun is waited for."""
    data = bytes(range(256)) * 256
    with connected(FastTcp) as (link, far):
        sock = link.driver.transport.sock  # type: ignore[attr-defined]
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1 << 14)
        far.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 14)  # which then stay so
        full = 0
        while full < 10:  # the system may find more room for what it has
            left = link.driver.transport.try_send([data])
            full = full + 1 if sum(map(len, left)) == len(data) else 0
            time.sleep(0.01)
        assert not link.send_whole(data)
        assert not link.sender.halfway
    with connected(FastTcp) as (link, far):
        taken = bytearray()

        def take() -> None:
            while part := far.recv(1 << 14):
                taken.extend(part)

        reader = threading.Thread(target=take)
        reader.start()
        count = 0
        while count < 200:
            count += link.send_whole(data)
        assert link.wait_sent()  # the rest of the last one, too
        assert (link.counter.messages, link.counter.bytes) == (200, 200 * len(data))
        link.close(quit_=False)
        reader.join()
        assert bytes(taken) == data * 200


def test_bytes_that_follow_by_themselves_are_counted() -> None:
    """Nobody writes again after the message of which only a part left at once."""
    link, transport = open_link(FastTcp)
    send, data = transport.try_send, b"x" * 1000
    transport.try_send = lambda buffers: [data[53:]]  # type: ignore[method-assign]
    assert link.send_whole(data) and link.sender.halfway
    assert link.counter.bytes == 53
    transport.try_send = send  # type: ignore[method-assign]
    assert link.wait_sent()
    assert (link.counter.messages, link.counter.bytes) == (1, 1000)
    link.close()


def test_at_once_to_one_that_has_gone() -> None:
    with connected(FastTcp) as (link, far):
        far.close()
        wait_until(lambda: not link.send_whole(b"x" * 1000))
        with pytest.raises(LinkClosed):
            link.send(Packet([1]))


def test_what_is_left_behind_the_end_has_no_flusher() -> None:
    """A signal handler has closed the port while the frame beneath was about to gather."""
    link, _ = open_link(FastTcp)
    sender = link.sender
    with sender.lock:
        sender.give_up()
        sender.halfway = True
        sender.follow()
    name = f"yarpy flush {link.route}"
    wait_until(lambda: name not in [thread.name for thread in threading.enumerate()])


def raises(sender: Sender) -> None:
    raise KeyboardInterrupt


def closes(sender: Sender) -> None:
    sender.driver.transport.interrupt()
    sender.give_up(at_rest=False)


@replaces_a_method
@pytest.mark.parametrize("act", [raises, closes])
@pytest.mark.parametrize("waiting", [0, 3])
@pytest.mark.parametrize("kind", [Tcp, FastTcp])
def test_whenever_a_signal_comes_each_message_is_in_the_books_once(
    kind: type[Carrier], waiting: int, act: Callable[[Sender], object]
) -> None:
    """As delivered only if its reader has it, or has said so."""
    size = len(b"".join(framing.encode(Packet([0]))))  # type: ignore[arg-type]
    number = 0
    for number, moment_ in enumerate(moments()):
        link, transport = open_link(kind)
        sender = link.sender
        with sender.lock:  # no timer sends what is gathered
            for _ in range(waiting):  # gathered, as in a flood
                sender._rush, sender._left = BURST, time.perf_counter() + 10
                sender.transmit(Packet([0]), moment(1))
                sender.window.until = time.perf_counter() + 10  # who is silent is waited for later
            sender._left = time.perf_counter() + 10 * bool(waiting)
            with suppress(KeyboardInterrupt, LinkClosed), moment_.interrupts(partial(act, sender)):
                sender.transmit(Packet([0]), moment(1))
            sender.give_up()
        came, counter = len(transport.said) // size, link.counter
        where = f"moment {number}: {came} came, {counter}"
        begun = total(link) > waiting or act is closes or not moment_.came
        assert total(link) == waiting + begun, where
        assert counter.messages <= came <= counter.messages + counter.unconfirmed, where
        assert counter.messages == 0 or not kind(link.route).acks, where
    assert number > 20
