"""The reader: from the mailbox or straight from the socket, and nobody notices which."""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from pathlib import Path

import pytest
from support.lasted import lasted
from support.moments import Cut, cut, moments
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, PortClosed, Timeout, UnknownName
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Message

KINDS = ["plain", "strict", "latest", "spinning"]


def make(kind: str, names: LocalNames) -> Port | BufferedPort:
    if kind in ("plain", "spinning"):
        return Port("/in", names=names, spin=kind == "spinning")
    return BufferedPort("/in", strict=kind == "strict", names=names)


@pytest.mark.parametrize("kind", KINDS)
def test_ping_pong_then_pause_then_ping_pong(kind: str, names: LocalNames) -> None:
    """A quick reader gets the lease, stays away, and comes back: nothing is lost or twice."""
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        number = 0
        for pause in (0, 0.08, 0, 0.012, 0):
            for _ in range(50):
                out.write([number])
                assert in_.read(timeout=HANG).value == [number]
                number += 1
            time.sleep(pause)
        assert in_.inputs[0].stats.messages == number
        assert in_.inputs[0].stats.drops == 0
        assert len(in_.inputs) == 1


@pytest.mark.parametrize("kind", KINDS)
def test_silence_is_no_failure(kind: str, names: LocalNames) -> None:
    """Time limits of a reader that had the lease do not stay with the connection."""
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=HANG)
        for _ in range(3):
            with pytest.raises(Timeout):
                in_.read(timeout=0.01)
        time.sleep(0.15)
        assert len(in_.inputs) == 1
        out.write(["after"])
        assert in_.read(timeout=HANG).value == ["after"]


@pytest.mark.parametrize("kind", KINDS)
def test_time_limit_is_kept_with_the_lease(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=HANG)
        for limit in (0, 0.005, 0.05, 0.15):
            started = time.monotonic()
            with pytest.raises(Timeout):
                in_.read(timeout=limit)
            assert limit - 0.002 <= time.monotonic() - started and lasted(started) < limit + 10


@pytest.mark.parametrize("kind", KINDS)
def test_interrupt_wakes_a_reader_with_the_lease(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=HANG)
        threading.Timer(0.05, in_.interrupt).start()
        started = time.monotonic()
        with pytest.raises(PortClosed):
            in_.read()
        assert lasted(started) < 10
        in_.resume()
        out.write(["after"])
        assert in_.read(timeout=HANG).value == ["after"]


@pytest.mark.parametrize("kind", KINDS)
def test_second_connection_while_a_reader_has_the_lease(kind: str, names: LocalNames) -> None:
    with (
        make(kind, names) as in_,
        Port("/out", names=names) as out,
        Port("/other", names=names) as other,
    ):
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=HANG)
        found: list[Message] = []
        reader = threading.Thread(target=lambda: found.append(in_.read(timeout=HANG)))
        reader.start()
        time.sleep(0.02)
        other.connect("/in")
        other.write(["hello"])
        reader.join(HANG)
        assert found[0].value == ["hello"]
        assert found[0].source == "/other"
        out.write(["again"])
        assert in_.read(timeout=HANG).value == ["again"]


@pytest.mark.parametrize("kind", KINDS)
def test_port_can_be_asked_while_a_reader_has_the_lease(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(20):
            out.write([number])
            in_.read(timeout=HANG)
        found: list[Message] = []
        reader = threading.Thread(target=lambda: found.append(in_.read(timeout=HANG)))
        reader.start()
        assert network.is_connected("/out", "/in", names=names)
        assert network.exists("/in", names=names)
        out.write(["after"])
        reader.join(HANG)
        assert found[0].value == ["after"]


@pytest.mark.parametrize("kind", ["plain", "spinning"])
def test_questions_with_the_lease(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, RpcClient("/in", names=names) as client:

        def serve() -> None:
            for number, message in enumerate(in_):
                if number % 10 == 9:
                    continue  # left open: the next read closes it
                message.reply([number])

        threading.Thread(target=serve, daemon=True).start()
        answers = [client.call("x", timeout=HANG) for _ in range(40)]
        assert answers == [[] if n % 10 == 9 else [n] for n in range(40)]


@pytest.mark.parametrize("kind", KINDS)
def test_sender_disconnects_while_a_reader_has_the_lease(kind: str, names: LocalNames) -> None:
    with make(kind, names) as in_, Port("/out", names=names) as out:
        for _ in range(3):
            out.connect("/in")
            for number in range(20):
                out.write([number])
                assert in_.read(timeout=HANG).value == [number]
            assert out.disconnect("/in")
            with pytest.raises(Timeout):
                in_.read(timeout=0.02)
            wait_until(lambda: not in_.inputs)


def test_latest_skips_while_its_reader_is_away(names: LocalNames) -> None:
    with BufferedPort("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(30):
            out.write([number])
            in_.read(timeout=HANG)
        time.sleep(0.05)
        for number in range(10):
            out.write([number], wait=True)
        assert in_.read(timeout=HANG).value == [9]
        assert in_.inputs[0].stats.replaced == 9


def test_latest_is_the_newest_for_a_reader_that_works_between_messages(names: LocalNames) -> None:
    """Two milliseconds of work are not enough for the link's thread to take over by itself."""
    with BufferedPort("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        number = 0
        newest: deque[bool] = deque(maxlen=50)

        def most_are_newest() -> bool:
            nonlocal number
            for _ in range(3):
                number += 1
                out.write([number])
            time.sleep(0.002)
            newest.append(in_.read(timeout=HANG).value == [number])
            return sum(newest) >= 40

        wait_until(most_are_newest)  # not at once on a busy computer


def test_polling_while_the_lease_is_out(names: LocalNames) -> None:
    """Who polls instead of reading gets what comes, a moment later at most."""
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        for number in range(30):
            out.write([number])
            in_.read(timeout=HANG)
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
        in_.read(timeout=HANG)
        assert in_.waiting == 9


# ------------------------------------------------------------------------- questions, threads


def test_several_threads_read_and_answer_side_by_side(names: LocalNames) -> None:
    """Nobody's `read` closes the question that another thread is still at."""
    with Port("/in", names=names) as in_:

        def work() -> None:
            for message in in_:
                time.sleep(0.001)  # another thread reads meanwhile
                message.reply([message.value[0] + 1])

        answers: list[object] = []

        def ask(number: int) -> None:
            with RpcClient("/in", names=names, name=f"/c{number}") as client:
                answers.extend(client.call([n], timeout=HANG)[0] - n for n in range(20))

        workers = [threading.Thread(target=work) for _ in range(3)]
        clients = [threading.Thread(target=ask, args=(number,)) for number in range(3)]
        for thread in (*workers, *clients):
            thread.start()
        for thread in clients:
            thread.join(60)
        assert answers == [1] * 60
    for thread in workers:
        thread.join(HANG)


def _hold(in_: Port, held: threading.Event, free: threading.Event) -> None:
    """Answer every question but `hold`, which is left when `free`."""
    for message in in_:
        if message.value[0] == "hold":
            held.set()
            free.wait(HANG)
        else:
            message.reply(["yes"])


def test_question_left_open_is_closed_though_another_connection_came(names: LocalNames) -> None:
    held, free = threading.Event(), threading.Event()
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
        reader = threading.Thread(target=_hold, args=(in_, held, free))
        reader.start()
        wait_until(lambda: client.call("x") and in_.inputs[0]._link.turn.leased, what="the lease")
        answers: list[object] = []
        asker = threading.Thread(target=lambda: answers.append(client.call("hold", timeout=HANG)))
        asker.start()
        assert held.wait(HANG)
        with RpcClient("/in", names=names) as other:
            free.set()
            assert other.call("x", timeout=HANG) == ["yes"]
        asker.join(HANG)
        assert answers == [[]]
    reader.join(HANG)


def test_question_of_an_asker_who_left_is_no_error_of_the_next_read(names: LocalNames) -> None:
    held, free = threading.Event(), threading.Event()
    with Port("/in", names=names) as in_:
        reader = threading.Thread(target=_hold, args=(in_, held, free))
        reader.start()
        with RpcClient("/in", names=names) as client:
            wait_until(
                lambda: client.call("x") and in_.inputs[0]._link.turn.leased, what="the lease"
            )
            with pytest.raises(Timeout):
                client.call("hold", timeout=0.05)
        free.set()
        with RpcClient("/in", names=names) as other:
            assert other.call("x", timeout=HANG) == ["yes"]
    reader.join(HANG)


class Slow:
    """A value that takes as long as a test wants to spell."""

    def __init__(self, value: object) -> None:
        self.begun, self.free = threading.Event(), threading.Event()
        self.value = value

    def to_wire(self) -> tuple[bytes]:
        self.begun.set()
        assert self.free.wait(HANG)
        if self.value is None:
            raise TypeError("not this")
        return (Bottle([self.value]).to_bytes(),)


def _answer(message: Message, value: Slow) -> None:
    with contextlib.suppress(TypeError, LinkClosed):
        message.reply(value)


@pytest.mark.parametrize("value", ["slow", None], ids=["sent", "not sent"])
@pytest.mark.parametrize("leased", [False, True], ids=["mailbox", "lease"])
def test_reader_leaves_a_question_that_another_thread_answers(
    leased: bool, value: object, names: LocalNames
) -> None:
    """It is answered once: by that thread, or, if that could not, by nothing."""
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
        answers: list[object] = []

        def ask() -> None:
            answers.extend(client.call(n, timeout=HANG) for n in range(60 if leased else 1))
            answers.append(client.call("last", timeout=HANG))

        asker = threading.Thread(target=ask)
        asker.start()
        message = in_.read(timeout=HANG)
        while leased and not in_.inputs[0]._link.turn.leased:
            message.reply(["quick"])
            message = in_.read(timeout=HANG)
        slow = Slow(value)
        worker = threading.Thread(target=_answer, args=(message, slow))
        worker.start()
        assert slow.begun.wait(HANG)
        with pytest.raises(Timeout):
            in_.read(timeout=0.1)
        threading.Timer(0.05, slow.free.set).start()
        expected: list[object] = [[value] if value else []]
        while (message := in_.read(timeout=HANG)).value != ["last"]:
            message.reply(["quick"])
            expected.append(["quick"])
        message.reply(["end"])
        asker.join(HANG)
        worker.join(HANG)
        assert answers[-len(expected) - 1 :] == [*expected, ["end"]]


@pytest.mark.parametrize("leased", [False, True], ids=["mailbox", "lease"])
def test_reader_that_is_interrupted_while_it_leaves_a_question_closes_it_next_time(
    leased: bool, names: LocalNames
) -> None:
    """Else whoever asks waits for ever, and so does the connection."""
    number = 0
    for number, moment in enumerate(moments()):
        with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
            answers: list[object] = []
            asker = threading.Thread(target=_ask_until, args=(client, answers), daemon=True)
            asker.start()
            message = in_.read(timeout=HANG)
            while leased and not in_.inputs[0]._link.turn.leased:
                message.reply(["quick"])
                message = in_.read(timeout=HANG)
            with contextlib.suppress(Cut, Timeout), moment.interrupts(cut):
                in_.read(timeout=0)
            with contextlib.suppress(Timeout):
                in_.read(timeout=0)
            asker.join(HANG)
            assert not asker.is_alive(), f"moment {number}"
    assert number > 10


def _ask_until(client: RpcClient, answers: list[object]) -> None:
    """Ask until a question is closed, or the connection, where part of an answer has left."""
    with contextlib.suppress(LinkClosed):
        while [] not in answers:
            answers.append(client.call("x", timeout=HANG))


@pytest.mark.parametrize("leased", [False, True], ids=["mailbox", "lease"])
def test_port_closes_while_another_thread_answers(
    leased: bool, names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    """It does not wait for that thread, nor write where that one may be writing."""
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
        failed: list[BaseException] = []

        def ask() -> None:
            with pytest.raises((LinkClosed, UnknownName)):
                while True:
                    client.call("x", timeout=HANG)

        asker = threading.Thread(target=ask)
        asker.start()
        message = in_.read(timeout=HANG)
        while leased and not in_.inputs[0]._link.turn.leased:
            message.reply(["quick"])
            message = in_.read(timeout=HANG)
        slow = Slow("late")

        def work() -> None:
            try:
                message.reply(slow)
            except BaseException as error:
                failed.append(error)

        worker = threading.Thread(target=work)
        worker.start()
        assert slow.begun.wait(HANG)
        served = in_.inputs[0]._link.served
        in_.close()
        assert served.wait(HANG)
        slow.free.set()
        for thread in (worker, asker):
            thread.join(HANG)
        assert [type(error) for error in failed] == [LinkClosed]
    assert "fails" not in caplog.text


def test_question_of_a_thread_that_ended_is_closed_by_the_next_read(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
        reader = threading.Thread(target=in_.read)
        reader.start()
        answers: list[object] = []
        asker = threading.Thread(target=lambda: answers.append(client.call("x", timeout=HANG)))
        asker.start()
        reader.join(HANG)
        with pytest.raises(Timeout):
            in_.read(timeout=0)
        asker.join(HANG)
        assert answers == [[]]


# ---------------------------------------------------------------------------- a silent port


def threads() -> set[Path]:
    return {*Path("/proc/self/task").iterdir()}


def switches(others: set[Path]) -> int:
    """How often threads of this process have gone to sleep by themselves, but for those others."""
    found = 0
    for thread in threads() - others:
        with contextlib.suppress(OSError):  # it has just ended
            text = (thread / "status").read_text()
            found += int(text.partition("\nvoluntary_ctxt_switches:")[2].split()[0])
    return found


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux's /proc")
@pytest.mark.parametrize("kind", ["plain", "strict", "latest"])
def test_nobody_wakes_up_on_a_silent_port(kind: str, names: LocalNames) -> None:
    """Neither a reader that had the socket to itself nor the thread of the connection."""
    others = threads()  # of tests before this one, and of pytest
    with make(kind, names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        # Not the question who listens here, which may still be on its way out.
        wait_until(lambda: [link.route.source for link in in_._hub.inputs.links] == ["/out"])
        link = in_.inputs[0]._link
        heard: list[Message] = []
        reader = threading.Thread(target=lambda: heard.extend(in_))
        reader.start()
        try:

            def has_lease() -> bool:
                out.write(["x"])
                return link.turn.leased

            wait_until(has_lease, HANG, what="a lease")
            wait_until(lambda: not link.turn.leased, what="its end")
            time.sleep(0.1)
            before = switches(others)
            time.sleep(1.0)
            assert switches(others) - before < 40
            count = len(heard)
            out.write(["after"])
            wait_until(lambda: len(heard) > count)
            assert heard[-1].value == ["after"]
        finally:
            in_.interrupt()
            reader.join(HANG)


def test_a_time_limit_is_a_number(names: LocalNames) -> None:
    with (
        Port("/in", names=names) as port,
        pytest.raises(TypeError, match="seconds or None, not '1'"),
    ):
        port.read(timeout="1")  # type: ignore[arg-type]
