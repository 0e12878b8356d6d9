"""Sockets at a path: Unix sockets, and what stands for them on Windows."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from support.wait import HANG

from yarpy.platform import local_socket
from yarpy.platform.local_socket import LOOPBACK, LoopbackListener, connect_loopback

Kind = tuple[Callable[[Path], Any], Callable[[Path, float], socket.socket]]
KINDS: dict[str, Kind] = {
    "of this system": (local_socket.Listener, local_socket.connect),
    "loopback": (LoopbackListener, connect_loopback),
}


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest) -> Kind:
    return KINDS[request.param]


@pytest.fixture
def pool() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor() as found:
        yield found


def test_bytes_go_both_ways(kind: Kind, tmp_path: Path, pool: ThreadPoolExecutor) -> None:
    listen, connect = kind
    listener = listen(tmp_path / "s")
    try:
        accepted = pool.submit(listener.accept)
        with connect(tmp_path / "s", HANG) as ours, accepted.result(HANG) as theirs:
            ours.sendall(b"question")
            assert theirs.recv(100) == b"question"
            theirs.sendall(b"answer")
            assert ours.recv(100) == b"answer"
    finally:
        listener.close()


def test_closing_wakes_who_waits_and_leaves_nothing(
    kind: Kind, tmp_path: Path, pool: ThreadPoolExecutor
) -> None:
    listen, connect = kind
    listener = listen(tmp_path / "s")
    waiting = threading.Event()

    def accept() -> None:
        waiting.set()
        listener.accept()

    accepted = pool.submit(accept)
    assert waiting.wait(HANG)
    listener.close()
    assert isinstance(accepted.exception(HANG), OSError)
    assert [*tmp_path.iterdir()] == []
    with pytest.raises(FileNotFoundError):
        connect(tmp_path / "s", HANG)


def test_what_a_killed_one_left_is_refused_and_taken_over(kind: Kind, tmp_path: Path) -> None:
    listen, connect = kind
    killed = listen(tmp_path / "s")
    killed._socket.close()
    with pytest.raises(ConnectionError):
        connect(tmp_path / "s", HANG)
    listener = listen(tmp_path / "s")
    connect(tmp_path / "s", HANG).close()
    listener.close()


def test_who_cannot_read_the_file_does_not_come_in(
    tmp_path: Path, pool: ThreadPoolExecutor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(local_socket, "_GREETING", 0.1)
    listener = LoopbackListener(tmp_path / "s")
    try:
        accepted = pool.submit(listener.accept)
        number, _, word = (tmp_path / "s").read_text().partition(" ")
        for said in (b"", word[:-1].encode(), word[::-1].encode(), b"\xff" * 32):
            with socket.create_connection((LOOPBACK, int(number)), HANG) as stranger:
                stranger.sendall(said)
                assert stranger.recv(1) == b""
        monkeypatch.setattr(local_socket, "_GREETING", HANG)
        with connect_loopback(tmp_path / "s", HANG) as ours, accepted.result(HANG) as theirs:
            ours.sendall(b"x")
            assert theirs.recv(1) == b"x"
    finally:
        listener.close()


def test_who_says_the_word_slowly_is_hung_up(
    tmp_path: Path, pool: ThreadPoolExecutor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(local_socket, "_GREETING", 0.3)
    listener = LoopbackListener(tmp_path / "s")
    accepted = pool.submit(listener.accept)
    number, _, word = (tmp_path / "s").read_text().partition(" ")
    try:
        with socket.create_connection((LOOPBACK, int(number)), HANG) as stranger:
            stranger.settimeout(0.1)  # between two letters, each of which comes in time
            with pytest.raises(ConnectionError):
                for letter in word:
                    stranger.sendall(letter.encode())
                    try:
                        assert stranger.recv(1) == b""
                        raise ConnectionError("hung up")
                    except TimeoutError:
                        pass
    finally:
        listener.close()
    assert isinstance(accepted.exception(HANG), OSError)


@pytest.mark.parametrize("text", ["", "x word", "99999999 word"])
def test_a_file_that_says_nothing_of_use(text: str, tmp_path: Path) -> None:
    (tmp_path / "s").write_text(text)
    with pytest.raises(ConnectionError):
        connect_loopback(tmp_path / "s", HANG)
