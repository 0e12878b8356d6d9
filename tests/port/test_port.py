"""Plain ports, end to end: each message is read once, its sender waits until it was."""

from __future__ import annotations

import gc
import socket
import struct
import threading
import time
import tracemalloc
from itertools import pairwise
from typing import Any

import pytest
from support import held
from support.lasted import lasted
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.data.bottle import Bottle
from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, LocalProtocolError, PortClosed, Timeout
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.port.rpc import RpcClient
from yarpy.wire import framing
from yarpy.wire.message import Message, Packet


def test_written_is_read(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        assert out.write([0]) == 0  # nobody is connected
        out.connect("/in")
        assert out.write([1, "two", [3.5]], Stamp(7, 1.25)) == 1
        message = in_.read(timeout=HANG)
        assert message.value == [1, "two", [3.5]]
        assert message.stamp == Stamp(7, 1.25)
        assert message.source == "/out"
        assert not message.wants_reply
        with pytest.raises(LocalProtocolError, match="does not wait for a reply"):
            message.reply([1])


def test_sender_waits_until_its_message_was_read(names: LocalNames) -> None:
    """`wait` returns with the acknowledgement, and that comes when the reader took the message."""
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        done: list[int] = []
        thread = threading.Thread(target=lambda: done.append(out.write([1], wait=True)))
        thread.start()
        time.sleep(0.05)
        assert done == []
        assert in_.read(timeout=HANG).value == [1]
        thread.join(HANG)
        assert done == [1]


def test_every_message_comes_once_and_in_order(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        count = 2000
        writer = threading.Thread(target=lambda: [out.write([n]) for n in range(count)])
        writer.start()
        assert [in_.read(timeout=HANG).value[0] for _ in range(count)] == list(range(count))
        writer.join(HANG)
        assert in_.poll() is None
        assert out.outputs[0].stats.messages == count
        assert in_.inputs[0].stats.messages == count


def test_busy_writer_of_the_same_process_does_not_slow_its_reader_down(names: LocalNames) -> None:
    """Both share one interpreter, whose threads take turns of five milliseconds: the reader must
    not need one of them for each message."""
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        count = 5000
        writer = threading.Thread(target=lambda: [out.write([n]) for n in range(count)])
        started = time.monotonic()
        writer.start()
        for _ in range(count):
            in_.read(timeout=HANG)
        writer.join(HANG)
        assert lasted(started) < 10  # 0.05 s on an idle machine


def test_several_writers_and_readers(names: LocalNames) -> None:
    """Four writers, three threads that read: every message of each comes once."""
    with Port("/in", names=names) as in_:
        count, found, lock = 300, {}, threading.Lock()

        def write(name: str) -> None:
            with Port(name, names=names) as out:
                out.connect("/in")
                for number in range(count):
                    out.write([number])
                out.flush(timeout=HANG)

        def read() -> None:
            for message in in_:
                with lock:
                    found.setdefault(message.source, []).append(message.value[0])

        readers = [threading.Thread(target=read) for _ in range(3)]
        writers = [threading.Thread(target=write, args=(f"/out{n}",)) for n in range(4)]
        for thread in (*readers, *writers):
            thread.start()
        for thread in writers:
            thread.join(HANG)
            assert not thread.is_alive()
        wait_until(lambda: sum(map(len, found.values())) == 4 * count)
        in_.interrupt()
        for thread in readers:
            thread.join(HANG)
        assert {name: sorted(numbers) for name, numbers in found.items()} == {
            f"/out{n}": list(range(count)) for n in range(4)
        }


def test_timeout_says_who_waited_how_long(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        started = time.monotonic()
        with pytest.raises(Timeout, match=r'"/in" within 0\.05 s'):
            in_.read(timeout=0.05)
        assert lasted(started) < 10
        with pytest.raises(Timeout):
            in_.read(timeout=0)
        assert in_.poll() is None


def test_iteration_ends_with_the_port(names: LocalNames) -> None:
    found: list[object] = []
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        thread = threading.Thread(target=lambda: found.extend(m.value[0] for m in in_))
        thread.start()
        for number in range(3):
            out.write([number], wait=True)
        in_.close()
        thread.join(HANG)
        assert not thread.is_alive()
    assert found == [0, 1, 2]
    assert list(in_) == []


# ---------------------------------------------------------------------------------- interrupt


def test_interrupt_wakes_a_reader_and_resume_goes_on(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        ended: list[Exception] = []

        def read() -> None:
            try:
                in_.read()
            except PortClosed as error:
                ended.append(error)

        thread = threading.Thread(target=read)
        thread.start()
        time.sleep(0.05)
        in_.interrupt()
        thread.join(HANG)
        assert len(ended) == 1
        with pytest.raises(PortClosed):
            in_.read(timeout=1)
        out.write([1], wait=True)  # what comes meanwhile is dropped, and counted
        assert in_.inputs[0].stats.drops == 1
        in_.resume()
        out.write([2])
        assert in_.read(timeout=HANG).value == [2]
        assert len(in_.inputs) == 1


def test_interrupted_port_does_not_write(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        out.interrupt()
        with pytest.raises(PortClosed, match="interrupted"):
            out.write([1])
        out.resume()
        out.write([2])
        assert in_.read(timeout=HANG).value == [2]


def test_close_while_reading_and_writing(names: LocalNames) -> None:
    """Closing both ends in the middle of a stream ends both threads, without an error."""
    out, in_ = Port("/out", names=names), Port("/in", names=names)
    out.connect("/in")
    problems: list[BaseException] = []

    def guard(work: object) -> None:
        try:
            assert callable(work)
            work()
        except PortClosed:
            pass
        except BaseException as error:
            problems.append(error)

    def write() -> None:
        while True:
            out.write([1])

    def read() -> None:
        while True:
            in_.read()

    threads = [threading.Thread(target=guard, args=(work,)) for work in (write, read)]
    for thread in threads:
        thread.start()
    time.sleep(0.1)
    in_.close()
    out.close()
    for thread in threads:
        thread.join(HANG)
        assert not thread.is_alive()
    assert problems == []
    with pytest.raises(PortClosed, match="closed"):
        out.write([1])
    with pytest.raises(PortClosed):
        in_.read(timeout=1)


# ---------------------------------------------------------------------------------- questions


def test_question_is_answered_by_the_reader(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:

        def serve() -> None:
            for message in in_:
                message.reply(["got", *message.value])

        threading.Thread(target=serve, daemon=True).start()
        for number in range(20):
            assert client.call("x", number, timeout=HANG) == ["got", "x", number]


def test_question_that_is_not_answered_ends_with_the_next_read(names: LocalNames) -> None:
    """The asker gets an empty answer instead of waiting for ever."""
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
        answers: list[object] = []
        thread = threading.Thread(target=lambda: answers.append(client.call("x", timeout=HANG)))
        thread.start()
        message = in_.read(timeout=HANG)
        assert message.wants_reply
        time.sleep(0.05)
        assert answers == []
        with pytest.raises(Timeout):
            in_.read(timeout=0.01)
        thread.join(HANG)
        assert answers == [[]]
        with pytest.raises(LocalProtocolError):
            message.reply(["too late"])


def test_answer_from_another_thread_and_only_once(names: LocalNames) -> None:
    with Port("/in", names=names) as in_, RpcClient("/in", names=names) as client:
        answers: list[object] = []
        thread = threading.Thread(target=lambda: answers.append(client.call("x", timeout=HANG)))
        thread.start()
        message = in_.read(timeout=HANG)
        threading.Timer(0.05, message.reply, (["late"],)).start()
        thread.join(HANG)
        assert answers == [["late"]]
        with pytest.raises(LocalProtocolError, match="answered already"):
            message.reply(["again"])


def test_asker_that_has_gone_is_an_error_of_reply(names: LocalNames) -> None:
    with Port("/in", names=names) as in_:
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as sock:
            sock.sendall(b"CONNACK asker\r\nd\r\n[1]\r\n")
            message = in_.read(timeout=HANG)
            # reset, so that sending fails
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        with pytest.raises(LinkClosed):
            for _ in range(100):
                message.reply(["x"])
                assert message.answer is not None
                message.answer.right.append(True)
                time.sleep(0.005)
        wait_until(lambda: not in_.inputs)


# ---------------------------------------------------------------------------------- callbacks


def test_callback_is_called_in_the_connections_thread(names: LocalNames) -> None:
    heard: list[tuple[object, str]] = []

    def callback(message: Message) -> None:
        heard.append((message.value[0], threading.current_thread().name))

    with (
        Port("/in", names=names, callback=callback) as in_,
        Port("/out", names=names) as out,
    ):
        out.connect("/in")
        for number in range(3):
            out.write([number], wait=True)
        assert [value for value, _ in heard] == [0, 1, 2]
        assert all("/out -> /in" in thread for _, thread in heard)
        with pytest.raises(PortClosed, match="callback"):
            in_.read(timeout=0)


def test_failing_callback_costs_one_message(
    names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[object] = []

    def callback(message: Message) -> None:
        if message.value == ["bad"]:
            raise ValueError("I do not like it")
        heard.append(message.value)

    with (
        Port("/in", names=names, callback=callback) as in_,
        Port("/out", names=names) as out,
    ):
        out.connect("/in")
        for value in (["a"], ["bad"], ["b"]):
            out.write(value, wait=True)
        assert heard == [["a"], ["b"]]
        assert in_.inputs[0].stats.drops == 1
    assert "I do not like it" in caplog.text


def test_callback_may_answer_and_write(names: LocalNames) -> None:
    """No lock is held while user code runs."""
    with (
        Port("/back", names=names) as back,
        Port("/relay", names=names, callback=lambda m: relay.write(m.value)) as relay,
        Port("/out", names=names) as out,
    ):
        relay.connect("/back")
        out.connect("/relay")
        for number in range(5):
            out.write([number])
            assert back.read(timeout=HANG).value == [number]


def test_callback_may_close_its_own_port(names: LocalNames) -> None:
    closed = threading.Event()

    def callback(message: Message) -> None:
        in_.close()
        closed.set()

    in_ = Port("/in", names=names, callback=callback)
    with Port("/out", names=names) as out:
        out.connect("/in")
        out.write([1])
        assert closed.wait(HANG)
        assert in_.closed
        wait_until(lambda: not in_._hub.inputs.links)
    in_.close()


# ---------------------------------------------------------------------------------- bad peers


def stranger(port: Port) -> socket.socket:
    sock = socket.create_connection(("127.0.0.1", port.contact.port), 5)
    sock.settimeout(5)
    return sock


GREETING = framing.number(framing.BASE + 131) + framing.encode_name("/stranger")


def test_peer_that_vanishes_in_the_middle_of_a_message(names: LocalNames) -> None:
    data = b"".join(framing.encode(Packet([bytes(100_000)])))  # type: ignore[arg-type]
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        with stranger(in_) as sock:
            sock.sendall(GREETING + data[:50_000])
            assert in_.wait_for_inputs(timeout=HANG)
        wait_until(lambda: not in_.inputs)
        assert in_.poll() is None
        out.connect("/in")
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]


@pytest.mark.parametrize(
    "garbage",
    [
        framing.INDEX + b"\x02\x01" + b"\xff" * 20,
        framing.INDEX + b"\xff\xff" + b"\xff" * 3000,
        framing.INDEX + b"\x01\x01" + b"\xff" * 8 + struct.pack("<2i", (1 << 31) - 1, 0),
    ],
)
def test_garbage_after_a_good_greeting(
    garbage: bytes, names: LocalNames, caplog: pytest.LogCaptureFixture
) -> None:
    """That connection ends with one line in the log; the port and the others live."""
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        with stranger(in_) as sock:
            sock.sendall(GREETING + garbage)
            assert sock.recv(8)
            assert sock.recv(8) == b""
        wait_until(lambda: len(in_.inputs) == 1)
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
    lines = [r for r in caplog.records if r.levelname in ("WARNING", "ERROR")]
    assert len(lines) == 1
    assert "/stranger" in lines[0].getMessage()


def test_message_beyond_the_limit(names: LocalNames, caplog: pytest.LogCaptureFixture) -> None:
    with Port("/in", names=names, limit=10_000) as in_, Port("/out", names=names) as out:
        out.connect("/in")
        out.write([bytes(1000)])
        assert len(in_.read(timeout=HANG).value[0]) == 1000
        out.write([bytes(100_000)])
        wait_until(lambda: "limit is 10000" in caplog.text)
        with pytest.raises(Timeout):
            in_.read(timeout=0.05)


def test_undecodable_message_is_the_readers_error_alone(names: LocalNames) -> None:
    from yarpy.errors import DecodeError

    bad = framing.INDEX + b"\x02\x01" + b"\xff" * 8 + struct.pack("<3i", 8, 12, 0)
    bad += b"\0\0\0\0~D\0\1" + struct.pack("<3i", 999, 1, 5)
    with Port("/in", names=names) as in_, stranger(in_) as sock:
        sock.sendall(GREETING + bad + b"".join(framing.encode(Packet([2]))))  # type: ignore[arg-type]
        message = in_.read(timeout=HANG)
        with pytest.raises(DecodeError):
            _ = message.value
        assert in_.read(timeout=HANG).value == [2]


def test_thousand_silent_connections_and_one_that_speaks(names: LocalNames) -> None:
    reason = "Windows' select watches 512 sockets at most"
    resource: Any = pytest.importorskip("resource", reason=reason)
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard != resource.RLIM_INFINITY and hard < 2500:
        pytest.skip(f"only {hard} files may be open here")
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, 2500), hard))
    silent: list[socket.socket] = []
    try:
        with Port("/in", names=names) as in_, Port("/out", names=names) as out:
            before = held.threads()
            silent += [stranger(in_) for _ in range(1000)]
            assert len(held.threads() - before) <= 1
            started = time.monotonic()
            out.connect("/in")
            out.write([1])
            assert in_.read(timeout=HANG).value == [1]
            assert network.exists("/in", names=names)
            assert lasted(started) < 10
    finally:
        for sock in silent:
            sock.close()
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


# ---------------------------------------------------------------------------------- memory


def test_memory_stays_flat_over_many_messages(names: LocalNames) -> None:
    """Thousands of messages leave nothing behind on either side."""
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in", "fast_tcp")

        def exchange(count: int) -> None:
            writer = threading.Thread(target=lambda: [out.write([n, "x"]) for n in range(count)])
            writer.start()
            for _ in range(count):
                in_.read(timeout=HANG)
            writer.join(HANG)

        exchange(2000)
        tracemalloc.start()
        try:
            sizes = []
            for _ in range(4):
                exchange(500)
                gc.collect()
                sizes.append(tracemalloc.get_traced_memory()[0])
        finally:
            tracemalloc.stop()
        # What a message leaves behind is there after every round; other threads' things are not.
        assert min(after - before for before, after in pairwise(sizes)) < 20_000
        assert in_.inputs[0].stats.messages == 4_000
        assert out.outputs[0].stats.messages == 4_000
        assert out.outputs[0].stats.drops == in_.inputs[0].stats.drops == 0


def test_large_messages_reuse_their_memory(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        picture = [bytes(1 << 20)]

        def exchange(count: int) -> None:
            for _ in range(count):
                out.write(picture)
                message = in_.read(timeout=HANG)
                assert len(message.payload) > 1 << 20

        exchange(3)
        tracemalloc.start()
        try:
            exchange(20)
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        assert peak < 4 << 20


# ---------------------------------------------------------------------------------- unregistered


def test_port_without_a_name_or_a_name_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reached by its address; no name service is asked."""
    monkeypatch.setenv("YARPY_SERVER", "127.0.0.1:9")
    with Port("") as in_, Port("") as out:
        assert in_.name.startswith("/")
        out.connect(f"/127.0.0.1:{in_.contact.port}")
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
        assert out.disconnect(out.outputs[0].target)


def test_bottle_is_bottle(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        out.write(Bottle.from_text("1 (a b) [set]"))
        assert in_.read(timeout=HANG).as_(Bottle).to_text() == "1 (a b) [set]"


def test_asking_every_connected_port(names: LocalNames) -> None:
    from yarpy.port.port import BufferedPort
    from yarpy.port.rpc import RpcServer

    with (
        Port("/asker", names=names) as asker,
        RpcServer("/one", lambda message: ["one", *message.value], names=names),
        RpcServer("/two", lambda message: ["two", *message.value], names=names),
        BufferedPort("/silent", names=names) as silent,
    ):
        assert asker.ask(["hi"]) == []
        asker.connect("/one")
        asker.write(["first"])  # acknowledged, while a question follows
        assert [answer.value for answer in asker.ask(["hi"])] == [["one", "hi"]]
        asker.connect("/two")
        assert [answer.value[0] for answer in asker.ask(["hi"])] == ["one", "two"]
        asker.connect("/silent")
        assert len(asker.ask(["hi"], timeout=HANG)) >= 2  # who only listens does not stop it
        assert silent.read(timeout=HANG).value == ["hi"]
        asker.close()
        with pytest.raises(PortClosed):
            asker.ask(["hi"])


def test_question_that_is_not_answered_in_time_ends_its_connection(names: LocalNames) -> None:
    from yarpy.port.rpc import RpcServer

    done = threading.Event()
    with (
        Port("/asker", names=names) as asker,
        RpcServer("/slow", lambda message: done.wait(HANG), names=names),
    ):
        asker.connect("/slow")
        assert asker.ask(["hi"], timeout=0.05) == []
        assert asker.outputs == []
        done.set()
