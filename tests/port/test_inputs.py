"""Connections into a port: who takes whose place, and when."""

from __future__ import annotations

import contextlib
import select
import socket
import threading
import time
from itertools import groupby

import pytest
from support.lasted import lasted
from support.wait import HANG, inside, runs, wait_until

from yarpy.nameserver.local import LocalNames
from yarpy.port import inputs
from yarpy.port.answer import name_conflicts
from yarpy.port.connection import ConnectionEvent
from yarpy.port.port import Port
from yarpy.wire.message import Message

# ---------------------------------------------------------------------------------- opening


def test_new_connection_of_the_same_sender_replaces_the_old(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for carrier in ("fast_tcp", "udp", "text_ack", "tcp"):
            out.connect("/in", carrier)
            assert [o.carrier for o in out.outputs] == [carrier]
            wait_until(lambda c=carrier: [i.carrier for i in in_.inputs] == [c])
            out.write([carrier])
            assert in_.read(timeout=HANG).value == [carrier]


def _dial_at_once(port: Port, greeting: bytes, count: int) -> list[socket.socket]:
    start = threading.Barrier(count)
    socks = [socket.socket() for _ in range(count)]

    def dial(sock: socket.socket) -> None:
        sock.connect(("127.0.0.1", port.contact.port))
        start.wait()
        sock.sendall(greeting)

    threads = [threading.Thread(target=dial, args=(sock,)) for sock in socks]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for sock in socks:
        sock.setblocking(False)
    return socks


def _is_over(sock: socket.socket) -> bool:
    try:
        while sock.recv(1000):
            pass  # the welcome
    except BlockingIOError:
        return False
    except OSError:
        pass
    return True


def test_of_connections_that_one_sender_makes_at_once_one_stays(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With two of them every message would come twice."""
    monkeypatch.setattr(inputs, "LEAVING", 0.01)  # which a rival waits in each round
    events: list[ConnectionEvent] = []
    with Port("/in", names=names) as in_:
        in_.on_connection(events.append)
        for number in range(50):
            socks = _dial_at_once(in_, b"CONNECT /same%d\r\n" % number, 4)
            # The first ones are replaced; who comes then is taken for a rival of that name.
            wait_until(lambda: sum(map(_is_over, socks)) == 3, what="three ended")  # noqa: B023
            assert len(in_.inputs) == 1
            for sock in socks:
                with contextlib.suppress(OSError):
                    sock.sendall(b"D\r\n%d\r\n" % number)
            assert in_.read(timeout=HANG).value == [number]
            for sock in socks:
                sock.close()
            wait_until(lambda: not in_.inputs)
        wait_until(lambda: sum(2 * event.created - 1 for event in events) == 0)
        for number in range(50):
            told = [event.created for event in events if event.source == f"/same{number}"]
            assert told == [True, False] * (len(told) // 2)
        assert in_.stats.past.inputs.messages == 50


def test_the_end_of_a_connection_is_told_before_the_next_one_of_its_sender(
    names: LocalNames,
) -> None:
    """What is told last is what is: a program would take a sender that is there for gone."""
    events: list[bool] = []

    def told(event: ConnectionEvent) -> None:
        if not event.created:
            wait_until(lambda: len(events) != 1 or runs("Inputs._let_end"))
        events.append(event.created)

    with Port("/in", names=names) as in_:
        in_.on_connection(told)
        for _ in range(2):
            with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
                sock.sendall(b"CONNECT /same\r\n")
                wait_until(lambda: in_.inputs and events)
            wait_until(lambda: not in_.inputs)
        wait_until(lambda: len(events) == 4)
    assert events == [True, False, True, False]


def test_nothing_of_a_replaced_connection_comes_after_its_successor(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inputs, "LEAVING", 0.01)  # which a rival waits in each round
    came: list[object] = []
    with Port("/in", names=names, callback=lambda message: came.append(message.value[0])) as in_:
        for _ in range(25):
            came.clear()
            socks = _dial_at_once(in_, b"", 4)
            for sock in socks:
                who = b"%d" % sock.fileno()
                sock.sendall(b"CONNECT /same\r\n" + b"D\r\n%b\r\n" % who * 20)
            wait_until(lambda: sum(map(_is_over, socks)) == 3)  # noqa: B023
            for sock in socks:
                sock.close()
            wait_until(lambda: not in_.inputs)
            each = [who for who, _ in groupby(came)]
            assert each and len(each) == len(set(each))


def test_a_program_that_reads_late_gets_what_a_replaced_connection_brought_first(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inputs, "SETTLING", 0.5)
    with contextlib.ExitStack() as stack:
        in_ = stack.enter_context(Port("/in", names=names))
        first, second = (
            stack.enter_context(socket.create_connection(("127.0.0.1", in_.contact.port)))
            for _ in range(2)
        )
        first.sendall(b"CONNECT /same\r\n" + b"".join(b"D\r\n%d\r\n" % n for n in range(5)))
        wait_until(lambda: in_.waiting == 1)
        second.sendall(b"CONNECT /same\r\n" + b"".join(b"D\r\n%d\r\n" % n for n in range(5, 9)))
        first.setblocking(False)
        wait_until(lambda: _is_over(first))
        time.sleep(1.4 * inputs.SETTLING)  # the second one would have begun
        assert [in_.read(timeout=HANG).value for _ in range(9)] == [[n] for n in range(9)]


@pytest.mark.skipif(not hasattr(select, "POLLRDHUP"), reason="the system cannot tell")
def test_a_sender_that_has_hung_up_behind_what_nobody_has_read_is_no_other_program(
    names: LocalNames, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was taken for two, and turned away for 90 s, where the program reads late."""
    monkeypatch.setattr(name_conflicts, "SOON", HANG)
    with Port("/in", names=names) as in_:
        found = in_._hub.inputs
        seen: list[object] = []
        for number in range(5):
            with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
                sock.sendall(b"CONNECT /same\r\n")
                assert sock.recv(1000).startswith(b"Welcome"), f"refused: {number}"
                wait_until(lambda: [link for link in found.links if link not in seen])
                seen.extend(found.links)
                sock.sendall(b"D\r\n1\r\n" * 5)
            wait_until(found.links[0].driver.transport.hung_up)
        assert not found._conflicts.refusal("/same")
    assert "two programs" not in caplog.text


def test_a_sender_may_connect_as_often_as_it_likes_over_datagrams(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    """It was taken for two programs, and turned away, since datagrams tell of no end."""
    with contextlib.ExitStack() as stack:
        in_ = stack.enter_context(Port("/in", names=names))
        for number in range(4):
            # The name is on its way back, as where a program was killed and started again.
            out = stack.enter_context(Port("/out", names=LocalNames()))
            out.connect(f"/{in_.address}", "udp")
            out.write([number])
            assert in_.read(timeout=HANG).value == [number]
    assert "two programs" not in caplog.text


def test_closing_waits_for_a_callback_with_what_a_replaced_connection_brought(
    names: LocalNames,
) -> None:
    busy, go, done = threading.Event(), threading.Event(), threading.Event()

    def callback(message: Message) -> None:
        busy.set()
        go.wait()
        time.sleep(0.1)
        done.set()

    with contextlib.ExitStack() as stack:
        port = Port("/in", names=names, callback=callback)
        first, second = (
            stack.enter_context(socket.create_connection(("127.0.0.1", port.contact.port)))
            for _ in range(2)
        )
        first.sendall(b"CONNECT /same\r\nD\r\n1\r\n")
        assert busy.wait(HANG)
        second.sendall(b"CONNECT /same\r\n")
        first.setblocking(False)
        wait_until(lambda: _is_over(first))
        go.set()
        port.close()
        assert done.is_set()


def test_closing_waits_until_the_program_is_told_of_an_end_that_came_before(
    names: LocalNames,
) -> None:
    told: list[bool] = []
    telling, go = threading.Event(), threading.Event()

    def tell(event: ConnectionEvent) -> None:
        if not event.created:
            telling.set()
            assert go.wait(HANG)
        told.append(event.created)

    port = Port("/in", names=names, on_connection=tell)
    with socket.create_connection(("127.0.0.1", port.contact.port)) as sock:
        sock.sendall(b"CONNECT /out\r\n")
        wait_until(lambda: told)
    assert telling.wait(HANG) and not port.inputs
    closing = inside("Inputs.close", go.set)
    port.close()
    assert told == [True, False]
    closing.join(HANG)


def test_unrooted_names_do_not_displace(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        socks = [socket.create_connection(("127.0.0.1", in_.contact.port)) for _ in range(3)]
        for sock in socks:
            sock.sendall(b"CONNECT visitor\r\n")
        wait_until(lambda: len(in_.inputs) == 3)
        for sock in socks:
            sock.close()
        wait_until(lambda: not in_.inputs)


def test_sender_that_is_busy_does_not_hold_its_successor_up(names: LocalNames) -> None:
    """The old connection waits for a reader; the new one takes its place all the same."""
    with Port("/in", names=names) as in_:
        first = socket.create_connection(("127.0.0.1", in_.contact.port))
        first.sendall(b"CONNECT /same\r\nD\r\n1\r\n")
        wait_until(lambda: in_.waiting == 1)
        started = time.monotonic()
        second = socket.create_connection(("127.0.0.1", in_.contact.port))
        second.sendall(b"CONNECT /same\r\nD\r\n2\r\n")
        assert in_.read(timeout=HANG).value == [1]
        assert in_.read(timeout=HANG).value == [2]
        assert lasted(started) < 10
        for sock in (first, second):
            sock.close()


# ---------------------------------------------------------------------------------- failures
