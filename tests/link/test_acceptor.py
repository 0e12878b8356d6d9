"""The acceptor: silent connections cost no thread, speaking ones get one."""

from __future__ import annotations

import resource
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager

import pytest
from support.wait import wait_until

from yarpy.link import acceptor as module
from yarpy.link.acceptor import Acceptor


@contextmanager
def accepting(
    serve: Callable[[socket.socket], None], speaks_first: bool = False
) -> Iterator[Acceptor]:
    acceptor = Acceptor("/here", 0, serve, speaks_first)
    try:
        yield acceptor
    finally:
        acceptor.close()


def dial(acceptor: Acceptor) -> socket.socket:
    sock = socket.create_connection(("127.0.0.1", acceptor.port), 5)
    sock.settimeout(5)
    return sock


def echo(sock: socket.socket) -> None:
    with sock:
        while data := sock.recv(100):
            sock.sendall(data)


def threads() -> int:
    return sum(thread.name.startswith("yarpy /here <- ") for thread in threading.enumerate())


def test_connection_is_served_once_it_speaks() -> None:
    with accepting(echo) as acceptor, dial(acceptor) as sock:
        time.sleep(0.05)
        assert threads() == 0
        sock.sendall(b"hello")
        assert sock.recv(10) == b"hello"
        assert threads() == 1
        sock.close()
        wait_until(lambda: threads() == 0)


def test_sign_of_life_costs_nothing() -> None:
    """Tools connect and hang up to see whether a port lives."""
    served: list[socket.socket] = []
    with accepting(served.append) as acceptor:
        for _ in range(20):
            dial(acceptor).close()
        with dial(acceptor) as sock:
            sock.sendall(b"x")
            wait_until(lambda: len(served) == 1)
    assert len(served) == 1
    served[0].close()


def test_thousand_silent_connections() -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard != resource.RLIM_INFINITY and hard < 2500:
        pytest.skip(f"only {hard} files may be open here")
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(soft, 2500), hard))
    try:
        with accepting(echo) as acceptor, ExitStack() as stack:
            silent = [stack.enter_context(dial(acceptor)) for _ in range(1000)]
            assert threads() == 0
            started = time.monotonic()
            with dial(acceptor) as sock:
                sock.sendall(b"I speak")
                assert sock.recv(10) == b"I speak"
            assert time.monotonic() - started < 5
            silent[500].sendall(b"me too")
            assert silent[500].recv(10) == b"me too"
            assert threads() <= 2
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def test_oldest_silent_one_goes_when_there_are_too_many(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(module, "MAX_SILENT", 3)
    with accepting(echo) as acceptor, ExitStack() as stack:
        silent = [stack.enter_context(dial(acceptor)) for _ in range(4)]
        assert silent[0].recv(1) == b""
        for sock in silent[1:]:
            sock.sendall(b"x")
            assert sock.recv(1) == b"x"
    assert "too many silent connections" in caplog.text


def test_no_more_files_is_survived(caplog: pytest.LogCaptureFixture) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with accepting(echo) as acceptor, ExitStack() as stack:
        old = [stack.enter_context(dial(acceptor)) for _ in range(5)]
        time.sleep(0.05)
        taken = [stack.enter_context(closing(socket.socket())) for _ in range(1)]
        resource.setrlimit(resource.RLIMIT_NOFILE, (taken[0].fileno() + 2, hard))
        try:
            # One file number is left for our side; the acceptor has none until it lets one go.
            fresh = stack.enter_context(socket.socket())
            fresh.settimeout(5)
            fresh.connect(("127.0.0.1", acceptor.port))
            fresh.sendall(b"x")
            assert fresh.recv(1) == b"x"
        finally:
            resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
        assert old[0].recv(1) == b""


def test_acceptor_speaks_first_when_it_must() -> None:
    """With a key the port begins: every connection is served at once."""

    def greet(sock: socket.socket) -> None:
        with sock:
            sock.sendall(b"who are you?")

    with accepting(greet, speaks_first=True) as acceptor, dial(acceptor) as sock:
        assert sock.recv(100) == b"who are you?"


def test_close_frees_the_number_and_the_silent() -> None:
    with accepting(echo) as acceptor:
        sock = dial(acceptor)
        time.sleep(0.02)
        number = acceptor.port
    assert sock.recv(1) == b""
    sock.close()
    wait_until(lambda: not acceptor.thread.is_alive())
    again = Acceptor("/here", number, echo)
    assert again.port == number
    again.close()


def test_number_that_is_taken() -> None:
    with accepting(echo) as acceptor, pytest.raises(OSError, match="in use"):
        Acceptor("/other", acceptor.port, echo)
