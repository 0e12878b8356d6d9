"""One thread accepts for all ports, and is there while there are ports."""

from __future__ import annotations

import os
import socket
import threading
from collections.abc import Callable
from contextlib import ExitStack

import pytest
from support import held
from support.wait import HANG, wait_until

from yarpy.link.begin import accept_loop, acceptor
from yarpy.link.begin.accept_loop import AcceptLoop
from yarpy.link.begin.acceptor import Acceptor


@pytest.fixture(params=[True, False], ids=["seen", "woken"])
def loop(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> AcceptLoop:
    """A loop of its own; also as on systems where the thread must be woken for a new socket."""
    if request.param and not accept_loop._SEES_MORE:
        pytest.skip("select() of this system does not see sockets that come while it waits")
    monkeypatch.setattr(accept_loop, "_SEES_MORE", request.param)
    made = AcceptLoop()
    monkeypatch.setattr(acceptor, "LOOP", made)
    return made


def echo(sock: socket.socket) -> None:
    with sock:
        while data := sock.recv(100):
            sock.sendall(data)


def ask(port: int) -> bytes:
    with socket.create_connection(("127.0.0.1", port), HANG) as sock:
        sock.sendall(b"some word")
        return sock.recv(9)


def test_one_thread_for_all_ports(loop: AcceptLoop) -> None:
    before = held.threads()
    for _ in range(2):  # it begins again when it has ended
        many = [Acceptor(f"/p{number}", 0, echo) for number in range(50)]
        thread = loop.thread
        assert thread is not None
        assert held.threads() - before == {thread}
        assert {one.thread_id for one in many} == {thread.native_id}
        assert {one.name for one in loop.listening} == {one.name for one in many}
        for one in many[::10]:
            assert ask(one.port) == b"some word"
        for one in many:
            one.close()
            with pytest.raises(ConnectionRefusedError):
                ask(one.port)
        assert loop.listening == []
        thread.join(HANG)
        assert loop.thread is None
        assert many[0].thread_id == -1
        wait_until(lambda: held.threads() <= before)


def test_opened_and_closed_by_many_threads(loop: AcceptLoop) -> None:
    failed: list[BaseException] = []

    def work() -> None:
        try:
            for _ in range(40):
                one = Acceptor("/p", 0, echo)
                assert ask(one.port) == b"some word"
                one.close()
        except BaseException as error:
            failed.append(error)

    workers = [threading.Thread(target=work) for _ in range(6)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not failed
    wait_until(lambda: loop.thread is None)


def test_one_that_fails_does_not_take_others_along(
    loop: AcceptLoop, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> None:
        raise MemoryError("no room")

    with ExitStack() as stack:
        bad, good = Acceptor("/bad", 0, echo), Acceptor("/good", 0, echo)
        stack.callback(good.close)
        stack.callback(bad.close)
        with monkeypatch.context() as patch:
            patch.setattr(bad, "_accept", fail)
            sock = stack.enter_context(socket.create_connection(("127.0.0.1", bad.port), HANG))
            wait_until(lambda: "/bad: a connection could not be accepted" in caplog.text)
            assert ask(good.port) == b"some word"
        sock.settimeout(HANG)
        sock.sendall(b"some word")
        assert sock.recv(9) == b"some word", "it goes on when the trouble is over"


def test_no_thread_no_port(loop: AcceptLoop, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(thread: threading.Thread) -> None:
        raise RuntimeError("can't start new thread")

    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", fail)
        with pytest.raises(RuntimeError):
            Acceptor("/here", 0, echo)
    assert loop.listening == []
    one = Acceptor("/here", 0, echo)
    assert ask(one.port) == b"some word"
    one.close()


def test_a_signal_while_the_thread_begins_leaves_none(
    loop: AcceptLoop, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And nobody hears of what became of it."""
    failed: list[object] = []
    monkeypatch.setattr(threading, "excepthook", failed.append)
    begun: list[threading.Thread] = []
    late = threading.Event()

    class Cut(threading.Thread):
        def start(self) -> None:
            begun.append(self)
            super().start()
            if len(begun) == 1:
                raise KeyboardInterrupt

        def run(self) -> None:
            assert len(begun) > 1 or late.wait(HANG)
            super().run()

    monkeypatch.setattr(accept_loop, "Thread", Cut)
    with pytest.raises(KeyboardInterrupt):
        Acceptor("/p", 0, echo)
    assert loop.thread is None
    other = Acceptor("/other", 0, echo)  # whose sockets the first one lets alone
    late.set()
    begun[0].join(HANG)
    assert not begun[0].is_alive()
    assert loop.thread is begun[1]
    assert ask(other.port) == b"some word"
    other.close()
    begun[1].join(HANG)
    assert not failed


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore:.*use of fork:DeprecationWarning")
def test_forked_process_begins_anew(loop: AcceptLoop) -> None:
    def child(report: Callable[[bytes], object]) -> None:
        loop.start_over()
        parents.abandon()
        parents.close()  # nobody is waited for
        own = Acceptor("/child", 0, echo)
        report(ask(own.port))
        own.close()

    parents = Acceptor("/parent", 0, echo)
    heard, said = os.pipe()
    process = os.fork()
    if not process:
        try:
            child(lambda word: os.write(said, word))
        finally:
            os._exit(0)
    os.close(said)
    with open(heard, "rb") as pipe:
        assert pipe.read() == b"some word"
    os.waitpid(process, 0)
    assert ask(parents.port) == b"some word"
    parents.close()
