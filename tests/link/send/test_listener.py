"""Listeners: what a reader says is heard at once, and costs its writer nothing."""

from __future__ import annotations

import threading
import time
from contextlib import suppress

from support.lasted import lasted
from support.outbound import connected
from support.wait import HANG, wait_until

from yarpy.carriers.base import Delivery
from yarpy.carriers.own.tcp import FastTcp
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.wire import framing
from yarpy.wire.message import Packet
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream


class AtOnce(FastTcp):
    delivery = Delivery(lossy=True, at_once=True, attentive=True)

    def __init__(self, route: Route) -> None:
        super().__init__(route)
        self.heard = b""

    def listen(self, stream: ByteStream) -> Steps[None]:
        while True:
            self.heard += yield from stream.read_exact(1)
            if self.heard.endswith(b"?"):
                stream.write(b"!")
            if self.heard.endswith(b"x"):
                raise RemoteProtocolError("nobody says x")


def test_what_does_not_leave_at_once_gives_way_to_what_comes_later() -> None:
    with connected(AtOnce) as (link, far):
        large = Packet([bytes(1_000_000)])
        left = [link.send(large) for _ in range(100)]
        assert left[0]
        assert not left[-1]
        messages, replaced = left.count(True), left.count(False)
        assert (link.counter.messages, link.counter.replaced) == (messages, replaced)
        size = messages * len(b"".join(bytes(block) for block in framing.encode(large)))
        while size:  # those that have begun come whole, and the last by itself
            size -= len(far.recv(size))
        wait_until(lambda: not link.sender.halfway)
        assert link.send(Packet([1]))


def test_a_slow_reader_costs_its_writer_nothing_and_is_not_cut_off_for_asking() -> None:
    with connected(AtOnce) as (link, far):
        large = Packet([bytes(1_000_000)])
        while link.send(large):
            pass  # now a part of one waits
        assert link.sender.halfway
        started = time.monotonic()
        # The system may find a little more room while it moves what it has taken.
        assert sum(link.send(large) for _ in range(1000)) < 100
        assert lasted(started) < 10  # much less, but for a busy machine
        thread = threading.Thread(target=link.attend)
        thread.start()
        far.sendall(b"how are you?")
        time.sleep(0.3)
        assert not link.broken
        data = b""
        while not data.endswith(b"!"):  # behind the messages
            data = data[-1:] + far.recv(1 << 20)
        assert link.send(Packet([1]))
        link.close(quit_=False)
        thread.join(HANG)
        assert not thread.is_alive()


def test_a_flood_of_questions_takes_no_memory() -> None:
    with connected(AtOnce) as (link, far):
        thread = threading.Thread(target=link.attend)
        thread.start()
        far.settimeout(0.5)
        asked = 0
        with suppress(TimeoutError):
            while asked < 1 << 26:
                asked += far.send(b"?" * (1 << 16))  # and none of the answers is read
        assert asked < 1 << 26
        waiting, _ = link.driver.stream.written()
        assert waiting < 1 << 23
        link.close(quit_=False)
        thread.join(HANG)


def test_what_a_reader_says_is_heard_at_once() -> None:
    with connected(AtOnce) as (link, far):
        thread = threading.Thread(target=link.attend)
        far.sendall(b"with the greeting?")
        thread.start()
        assert far.recv(10) == b"!"
        far.sendall(b"later?")
        assert far.recv(10) == b"!"
        far.sendall(b"x")
        thread.join(HANG)
        assert not thread.is_alive()
        assert link.broken
        assert link.reason == "nobody says x"


def test_a_link_that_is_closed_is_listened_to_no_more() -> None:
    with connected(AtOnce) as (link, _):
        thread = threading.Thread(target=link.attend)
        thread.start()
        link.close(quit_=False)
        thread.join(HANG)
        assert not thread.is_alive()
