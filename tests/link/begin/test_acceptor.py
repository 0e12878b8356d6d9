"""The acceptor: silent connections cost no thread, speaking ones get one."""

from __future__ import annotations

import errno
import gc
import os
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress

import pytest
from support.lasted import lasted
from support.open_files import limited, resource
from support.wait import wait_until

from yarpy.link.begin import descriptors, pending
from yarpy.link.begin.acceptor import Acceptor

waits_for_a_word = pytest.mark.skipif(
    sys.platform == "win32", reason="Windows has no SO_RCVLOWAT: one byte wakes the thread"
)


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
        sock.sendall(b"hello there")
        assert sock.recv(20) == b"hello there"
        assert threads() == 1
        sock.close()
        wait_until(lambda: threads() == 0)


@waits_for_a_word
def test_less_than_a_word_costs_no_thread() -> None:
    with accepting(echo) as acceptor, dial(acceptor) as sock, dial(acceptor) as other:
        sock.sendall(b"GET")
        other.sendall(b"1234567")
        other.close()  # and this one never says more
        time.sleep(0.05)
        assert threads() == 0
        sock.sendall(b" / HTTP")
        assert sock.recv(20) == b"GET / HTTP"


@waits_for_a_word
def test_who_stays_silent_is_let_go(monkeypatch: pytest.MonkeyPatch) -> None:
    with accepting(echo) as acceptor, dial(acceptor) as spoke:
        spoke.sendall(b"some word")
        assert spoke.recv(9) == b"some word"
        monkeypatch.setattr(pending, "TIMEOUT", 0.2)
        with dial(acceptor) as sock, suppress(ConnectionResetError):
            sock.sendall(b"x")
            assert sock.recv(1) == b""
        spoke.sendall(b"and more")  # who has said what it speaks may be silent
        assert spoke.recv(8) == b"and more"


def test_more_than_are_served_are_refused(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("YARPY_CONNECTIONS", "4")
    with accepting(echo) as acceptor, ExitStack() as stack:
        for _ in range(4):
            sock = stack.enter_context(dial(acceptor))
            sock.sendall(b"some word")
            assert sock.recv(9) == b"some word"
        for _ in range(5):
            with dial(acceptor) as refused:
                refused.sendall(b"some word")
                with suppress(ConnectionError):
                    assert refused.recv(9) == b""
        wait_until(lambda: threads() == 4)
        assert caplog.text.count("refuses more") == 1
        stack.close()
        wait_until(lambda: "takes connections again (5 times" in caplog.text)
        with dial(acceptor) as sock:
            sock.sendall(b"some word")
            assert sock.recv(9) == b"some word"


def test_last_descriptors_are_left_to_the_program(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The port takes no connections while they run short, says so once, and goes on later."""
    with accepting(echo) as acceptor, ExitStack() as stack:
        free = [20]
        monkeypatch.setattr(descriptors, "allowed", lambda: 1000)
        monkeypatch.setattr(descriptors, "used", lambda most: most - free[0])
        monkeypatch.setattr(descriptors, "STALE", 0.0)
        waiting = [stack.enter_context(dial(acceptor)) for _ in range(3)]
        for sock in waiting:
            sock.sendall(b"some word")
        wait_until(lambda: "takes no connections for now" in caplog.text)
        waiting[0].settimeout(0.6)
        with pytest.raises(TimeoutError):
            waiting[0].recv(9)
        free[0] = 500
        for sock in waiting:
            sock.settimeout(5)
            assert sock.recv(9) == b"some word"
    assert caplog.text.count("takes no connections for now") == 1
    assert caplog.text.count("takes connections again") == 1


def test_sign_of_life_costs_nothing() -> None:
    """Tools connect and hang up to see whether a port lives."""
    served: list[socket.socket] = []
    with accepting(served.append) as acceptor:
        for _ in range(20):
            dial(acceptor).close()
        with dial(acceptor) as sock:
            sock.sendall(b"some word")
            wait_until(lambda: len(served) == 1)
    assert len(served) == 1
    served[0].close()


@limited
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
                sock.sendall(b"I can speak")
                assert sock.recv(20) == b"I can speak"
            assert lasted(started) < 10
            silent[500].sendall(b"me too, please")
            assert silent[500].recv(20) == b"me too, please"
            assert threads() <= 2
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def test_oldest_silent_one_goes_when_there_are_too_many(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(pending, "MOST", 3)
    with accepting(echo) as acceptor, ExitStack() as stack:
        silent = [stack.enter_context(dial(acceptor)) for _ in range(4)]
        assert silent[0].recv(1) == b""
        for sock in silent[1:]:
            sock.sendall(b"some word")
            assert sock.recv(9) == b"some word"
    assert "too many silent connections" in caplog.text


@limited
def test_no_more_files_is_survived(caplog: pytest.LogCaptureFixture) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    with accepting(echo) as acceptor, ExitStack() as stack:
        old = [stack.enter_context(dial(acceptor)) for _ in range(5)]
        with dial(acceptor) as later:  # once it is answered, those before it are accepted
            later.sendall(b"some word")
            assert later.recv(9) == b"some word"
        wait_until(lambda: threads() == 0)
        gc.collect()  # files of earlier tests, which would free numbers below
        last = 0  # the highest number there is; the one behind it is the listing's own
        while last + 1 < max(int(number) for number in os.listdir("/dev/fd")):
            last = stack.enter_context(closing(socket.socket())).fileno()
        resource.setrlimit(resource.RLIMIT_NOFILE, (last + 2, hard))
        try:
            # One file number is left for our side; the acceptor has none until it lets one go.
            fresh = stack.enter_context(socket.socket())
            fresh.settimeout(5)
            fresh.connect(("127.0.0.1", acceptor.port))
            fresh.sendall(b"some word")
            assert fresh.recv(9) == b"some word"
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
        wait_until(lambda: len(acceptor._pending) == 1)
        number = acceptor.port
    assert sock.recv(1) == b""
    sock.close()
    again = Acceptor("/here", number, echo)
    assert again.port == number
    again.close()


def test_number_that_is_taken() -> None:
    with accepting(echo) as acceptor, pytest.raises(OSError) as caught:
        Acceptor("/other", acceptor.port, echo)
    assert caught.value.errno == errno.EADDRINUSE
