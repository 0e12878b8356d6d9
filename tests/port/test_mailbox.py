"""Reading policies: what is kept, what is dropped and counted, who waits, how it stops."""

from __future__ import annotations

import logging
import sys
import threading
import time
import tracemalloc
from types import FrameType

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until
from support.way_back import way_back

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError, PortClosed
from yarpy.link.counter import Counter
from yarpy.nameserver.local import LocalNames
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox, Rendezvous, memory
from yarpy.port.port import BufferedPort
from yarpy.wire.message import CALL, DATA, Message


class Link:
    """As much of an inbound link as a mailbox needs."""

    class Owner:
        name = "/here"

    class Route:
        source = "/peer"

    def __init__(self) -> None:
        self.counter = Counter()
        self.owner = self.Owner()
        self.route = self.Route()


def message(value: object, key: str = DATA) -> Message:
    return Message(key, Bottle([value]).to_bytes())


def put(box: Mailbox, link: Link, value: object) -> None:
    box.put(link, message(value))  # type: ignore[arg-type]


def taken(box: Mailbox, timeout: float = HANG) -> object:
    found = box.take(timeout)
    return None if found is None else found.value[0]


# ---------------------------------------------------------------------------------- latest


def test_latest_keeps_the_newest_and_counts_the_rest() -> None:
    box, link = Latest(), Link()
    for number in range(10):
        put(box, link, number)
    assert box.waiting == 1
    assert taken(box) == 9
    assert box.take(0) is None
    assert (link.counter.replaced, box.drops) == (9, 0)


def test_latest_counts_on_the_link_whose_message_was_replaced() -> None:
    box, first, second = Latest(), Link(), Link()
    put(box, first, 1)
    put(box, second, 2)
    assert (first.counter.replaced, second.counter.replaced) == (1, 0)
    assert taken(box) == 2


@pytest.mark.parametrize("kind", [Latest, Fifo, Rendezvous])
@pytest.mark.parametrize("moment", range(16))
def test_an_interrupt_that_a_signal_handler_cuts_loses_nothing_uncounted(
    kind: type[Mailbox], moment: int
) -> None:
    """Wherever in it the handler raises, as by Ctrl-C during `close`."""
    box, link = kind(), Link()
    threads = [threading.Thread(target=put, args=(box, link, number)) for number in range(3)]
    for thread in threads:
        thread.start()
    wait_until(lambda: link.counter.replaced + box.waiting == 3)
    left = [moment]

    def cut(frame: FrameType, event: str, argument: object) -> object:
        if "mailbox" in frame.f_code.co_filename and event == "call":  # where Python looks for one
            left[0] -= 1
            if left[0] < 0:
                sys.settrace(None)
                raise KeyboardInterrupt
        return None

    sys.settrace(cut)
    try:
        box.interrupt()
    except KeyboardInterrupt:
        pass
    finally:
        sys.settrace(None)
    box.interrupt()
    for thread in threads:
        thread.join(HANG)
        assert not thread.is_alive()
    assert link.counter.drops + link.counter.replaced == box.drops + link.counter.replaced == 3


@pytest.mark.parametrize("kind", [Latest, Fifo])
def test_nothing_is_lost_uncounted_between_threads(kind: type[Mailbox]) -> None:
    """Several connections put, several readers take: put = taken + replaced + drops."""
    box, links = kind(), [Link() for _ in range(4)]
    count, found = 3000, []

    def write(link: Link) -> None:
        for number in range(count):
            put(box, link, number)

    def read() -> None:
        while True:
            try:
                one = box.take(5)
            except PortClosed:
                return
            if one is not None:
                found.append(one)

    writers = [threading.Thread(target=write, args=(link,)) for link in links]
    readers = [threading.Thread(target=read) for _ in range(3)]
    for thread in (*writers, *readers):
        thread.start()
    for thread in writers:
        thread.join(HANG)
    wait_until(lambda: box.waiting == 0)
    time.sleep(0.01)
    box.interrupt()
    for thread in readers:
        thread.join(HANG)
    drops = sum(link.counter.drops for link in links)
    replaced = sum(link.counter.replaced for link in links)
    assert len(found) + replaced + drops == 4 * count
    assert box.drops == drops
    if kind is Fifo:
        assert drops == replaced == 0


# ---------------------------------------------------------------------------------- strict


def test_fifo_keeps_everything_in_order() -> None:
    box, link = Fifo(), Link()
    for number in range(100):
        put(box, link, number)
    assert box.waiting == 100
    assert [taken(box) for _ in range(100)] == list(range(100))
    assert link.counter.drops == 0


@pytest.mark.parametrize("carrier", ["tcp", "text_ack", "local"])
@pytest.mark.parametrize("value", [[1], ["x" * 1000], [[n, n] for n in range(20)]])
def test_fifo_counts_what_messages_really_take(carrier: str, value: list[object]) -> None:
    """Small messages take several times their payload."""
    names, count = LocalNames(), 2000
    with (
        BufferedPort("/in", strict=True, names=names) as in_,
        BufferedPort("/out", strict=True, names=names) as out,
    ):
        out.connect("/in", carrier)
        assert out.write(value, wait=carrier != "local")
        in_.read(timeout=HANG)
        tracemalloc.start()
        try:
            before, _ = tracemalloc.get_traced_memory()
            for _ in range(count):
                out.write(value)
            wait_until(lambda: in_.waiting == count, timeout=HANG)
            taken = tracemalloc.get_traced_memory()[0] - before
        finally:
            tracemalloc.stop()
        box = in_._hub.inputs.mailbox
        assert isinstance(box, Fifo)
        assert taken < 1.5 * box._bytes


def test_fifo_counts_objects_that_came_as_they_are() -> None:
    import numpy as np

    assert memory(b"x" * 1000) > 1000
    assert memory(np.zeros(1000)) > 8000
    assert memory(["x" * 1000] * 100) > 100_000
    assert memory([["x" * 100] * 10] * 10) > 10_000
    assert memory(yarpy.Image(np.zeros((10, 10, 3), np.uint8))) > 300


def test_fifo_that_is_full_makes_its_senders_wait() -> None:
    box, link = Fifo(limit=4000), Link()
    done = threading.Event()

    def write() -> None:
        for number in range(50):
            put(box, link, number)
        done.set()

    threading.Thread(target=write, daemon=True).start()
    assert not done.wait(0.05)
    assert box.waiting < 50
    assert [taken(box) for _ in range(50)] == list(range(50))
    assert done.wait(HANG)
    assert link.counter.drops == 0


def test_fifo_lets_waiting_senders_go_when_it_stops() -> None:
    box, link = Fifo(limit=100), Link()
    thread = threading.Thread(target=lambda: [put(box, link, n) for n in range(10)], daemon=True)
    thread.start()
    wait_until(lambda: box.waiting >= 1)
    time.sleep(0.02)
    box.interrupt()
    thread.join(HANG)
    assert not thread.is_alive()
    assert link.counter.drops == 10


# ---------------------------------------------------------------------------------- rendezvous


def test_sender_waits_until_its_message_is_taken() -> None:
    box, link = Rendezvous(), Link()
    passed: list[int] = []

    def write() -> None:
        for number in range(3):
            put(box, link, number)
            passed.append(number)

    threading.Thread(target=write, daemon=True).start()
    wait_until(lambda: box.waiting == 1)
    time.sleep(0.02)
    assert passed == []
    for number in range(3):
        assert taken(box) == number
        wait_until(lambda number=number: passed == list(range(number + 1)))


def test_question_holds_its_connection_until_it_is_answered() -> None:
    box, link = Rendezvous(), Link()
    answers: list[object] = []
    question = message("ask", CALL)
    question.answer = way_back(answers.append)
    thread = threading.Thread(target=box.put, args=(link, question), daemon=True)
    thread.start()
    found = box.take(5)
    assert found is not None
    time.sleep(0.02)
    assert thread.is_alive()
    found.reply("yes")
    thread.join(HANG)
    assert answers == ["yes"]


@pytest.mark.parametrize("how", ["settle", "close"])
def test_question_that_is_left_open_is_closed(how: str) -> None:
    box, link = Rendezvous(), Link()
    question = message("ask", CALL)
    question.answer = way_back()
    thread = threading.Thread(target=box.put, args=(link, question), daemon=True)
    thread.start()
    assert box.take(5) is not None
    getattr(box, how)()
    thread.join(HANG)
    assert not thread.is_alive()
    assert question.answer.forsaken is (how == "close")


def test_question_that_was_read_is_answered_though_the_reader_was_interrupted() -> None:
    box, link, answers = Rendezvous(), Link(), []
    question = message("ask", CALL)
    question.answer = way_back(answers.append)
    thread = threading.Thread(target=box.put, args=(link, question), daemon=True)
    thread.start()
    found = box.take(5)
    assert found is not None
    box.interrupt()
    assert thread.is_alive()
    found.reply("yes")
    thread.join(HANG)
    assert answers == ["yes"]


def test_connection_goes_on_when_its_asker_has_gone() -> None:
    box, link = Rendezvous(), Link()

    def gone(value: object) -> None:
        raise ConnectionError("gone")

    question = message("ask", CALL)
    question.answer = way_back(gone)
    thread = threading.Thread(target=box.put, args=(link, question), daemon=True)
    thread.start()
    found = box.take(5)
    assert found is not None
    with pytest.raises(ConnectionError):
        found.reply("too late")
    thread.join(HANG)
    assert not thread.is_alive()


# ---------------------------------------------------------------------------------- callback


def test_callback_runs_in_the_threads_of_connections(caplog: pytest.LogCaptureFixture) -> None:
    heard: list[tuple[object, str]] = []
    box = Callback(lambda m: heard.append((m.value[0], threading.current_thread().name)))
    thread = threading.Thread(target=put, args=(box, Link(), 5), name="of the connection")
    thread.start()
    thread.join(HANG)
    assert heard == [(5, "of the connection")]
    with pytest.raises(PortClosed, match="callback"):
        box.take(0)


@pytest.mark.parametrize(
    ("error", "level", "traceback"),
    [
        (ZeroDivisionError("oh"), logging.ERROR, True),
        (DecodeError("no Bottle"), logging.WARNING, False),
        (PortClosed("closed"), None, False),
    ],
)
def test_failing_callback_is_logged_and_counted(
    error: Exception, level: int | None, traceback: bool, caplog: pytest.LogCaptureFixture
) -> None:
    def handle(message: Message) -> None:
        raise error

    box, link = Callback(handle), Link()
    put(box, link, 1)
    put(box, link, 2)
    assert link.counter.drops == 2
    if level is None:
        assert caplog.records == []
    else:
        assert [record.levelno for record in caplog.records] == [level] * 2
        assert bool(caplog.records[0].exc_info) == traceback
        assert "/here" in caplog.records[0].getMessage()


def test_a_callback_that_exits_is_told_so(caplog: pytest.LogCaptureFixture) -> None:
    box, link = Callback(lambda message: sys.exit(3)), Link()
    thread = threading.Thread(target=put, args=(box, link, 1))
    thread.start()
    thread.join(HANG)
    assert link.counter.drops == 1
    [record] = caplog.records
    assert (record.levelno, record.exc_info) == (logging.ERROR, None)
    assert "sys.exit() in a thread of a port ends no program" in record.getMessage()


def test_locked_callback_is_called_one_at_a_time() -> None:
    inside: list[int] = []
    most: list[int] = []

    def handle(message: Message) -> None:
        inside.append(1)
        most.append(len(inside))
        time.sleep(0.005)
        inside.pop()

    box = Callback(handle, lock=True)
    threads = [threading.Thread(target=put, args=(box, Link(), n)) for n in range(5)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(HANG)
    assert max(most) == 1
    assert len(most) == 5


# ---------------------------------------------------------------------------------- stop and go


@pytest.mark.parametrize("kind", [Latest, Fifo, Rendezvous])
def test_interrupt_wakes_every_reader(kind: type[Mailbox]) -> None:
    box = kind()
    ended: list[str] = []

    def read() -> None:
        try:
            box.take(5)
        except PortClosed as error:
            ended.append(str(error))

    threads = [threading.Thread(target=read) for _ in range(3)]
    for thread in threads:
        thread.start()
    time.sleep(0.02)
    box.interrupt()
    for thread in threads:
        thread.join(HANG)
    assert len(ended) == 3
    with pytest.raises(PortClosed):
        box.take(0)
    with pytest.raises(PortClosed):
        box.poll()
    assert box.waiting == 0


@pytest.mark.parametrize("kind", [Latest, Fifo])
def test_what_waits_and_what_comes_is_dropped_and_counted(kind: type[Mailbox]) -> None:
    box, link = kind(), Link()
    for number in range(3):
        put(box, link, number)
    box.interrupt()
    put(box, link, 3)
    assert link.counter.replaced + link.counter.drops == 4
    box.resume()
    assert box.waiting == 0
    assert box.poll() is None
    put(box, link, 4)
    assert box.waiting == 1
    assert taken(box) == 4
    assert link.counter.replaced + link.counter.drops == 4


def test_senders_of_a_plain_port_are_let_go() -> None:
    box, link = Rendezvous(), Link()
    threads = [threading.Thread(target=put, args=(box, link, n), daemon=True) for n in range(3)]
    for thread in threads:
        thread.start()
    wait_until(lambda: box.waiting == 3)
    box.interrupt()
    for thread in threads:
        thread.join(HANG)
        assert not thread.is_alive()
    put(box, link, 4)  # returns at once
    assert link.counter.drops == 4
    box.resume()
    assert box.take(0) is None


@pytest.mark.parametrize("kind", [Latest, Fifo, Rendezvous])
def test_no_message_slips_in_while_stopping(kind: type[Mailbox]) -> None:
    """A sender that comes at the very moment of an interrupt neither hangs nor is forgotten."""
    for _ in range(200):
        box, link = kind(), Link()
        ready = threading.Barrier(2)

        def write(box: Mailbox = box, link: Link = link, ready: threading.Barrier = ready) -> None:
            ready.wait()
            put(box, link, 1)

        thread = threading.Thread(target=write, daemon=True)
        thread.start()
        ready.wait()
        box.interrupt()
        thread.join(HANG)
        assert not thread.is_alive()
        assert link.counter.drops == 1
        assert box.waiting == 0


def test_polling_does_not_wait() -> None:
    box, link = Latest(), Link()
    assert box.poll() is None
    put(box, link, 1)
    found = box.poll()
    assert found is not None
    assert found.value == [1]
    assert box.poll() is None


def test_time_limit_of_taking() -> None:
    started = time.monotonic()
    assert Latest().take(0.05) is None
    assert time.monotonic() - started > 0.04 and lasted(started) < 10
