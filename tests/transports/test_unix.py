"""Unix sockets: where they lie, how the two sides meet, what is cleaned up."""

from __future__ import annotations

import os
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from support.system import NO_ROOT, NO_TAKEN, NO_UNIX_SOCKETS
from support.wait import HANG

from yarpy.errors import LocalProtocolError, PortClosed, Timeout
from yarpy.scope import Scope, moment
from yarpy.transports import unix
from yarpy.transports.unix import UnixTransport, open_unix, runtime_directory

pytestmark = pytest.mark.skipif(bool(NO_UNIX_SOCKETS), reason=NO_UNIX_SOCKETS)

ACCEPTOR, INITIATOR = ("127.0.0.1", 21605), ("127.0.0.1", 47340)


@pytest.fixture(autouse=True)
def directory(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A short path, as sockets need it."""
    with tempfile.TemporaryDirectory(dir="/tmp") as short:
        monkeypatch.setenv("YARP_RUNTIME_DIR", short)
        yield Path(short)


def meet() -> tuple[UnixTransport, UnixTransport]:
    listening = open_unix(True, ACCEPTOR, INITIATOR)
    dialling = open_unix(False, INITIATOR, ACCEPTOR)
    thread = threading.Thread(target=listening.ready)
    thread.start()
    dialling.ready()
    thread.join(HANG)
    return listening, dialling


def test_path_is_made_of_both_numbers(directory: Path) -> None:
    listening = open_unix(True, ACCEPTOR, INITIATOR)
    assert [p.name for p in directory.iterdir()] == ["21605_47340.sock"]
    listening.close()
    assert list(directory.iterdir()) == []


def test_two_sides_meet_and_the_path_is_gone(directory: Path) -> None:
    listening, dialling = meet()
    assert list(directory.iterdir()) == []
    room = memoryview(bytearray(10))
    dialling.send([b"there"])
    assert listening.recv_into(room) == 5
    listening.send([b"back"])
    assert dialling.recv_into(room) == 4
    dialling.close()
    assert listening.recv_into(room) == 0
    listening.close()


@pytest.mark.skipif(bool(NO_TAKEN), reason=NO_TAKEN)
def test_what_was_taken_is_not_known_once_another_thread_has_closed_it() -> None:
    listening, dialling = meet()
    dialling.send([b"there"])
    assert dialling.taken(5, 0) is not None
    dialling.close()
    assert dialling.taken(5, 0) is None
    listening.close()


def test_nobody_is_waited_for_beyond_the_call_nor_the_life_of_its_port() -> None:
    with closing(open_unix(False, INITIATOR, ACCEPTOR)) as dialling:
        with Scope(moment(0.1)), pytest.raises(Timeout, match="the peer is silent"):
            dialling.ready()
        with Scope() as call, pytest.raises(PortClosed, match="the end of the port"):
            dialling.ready(lambda: call.end("the end of the port"))


def test_dialling_side_may_come_first() -> None:
    dialling = open_unix(False, INITIATOR, ACCEPTOR)
    thread = threading.Thread(target=dialling.ready)
    thread.start()
    time.sleep(0.1)
    listening = open_unix(True, ACCEPTOR, INITIATOR)
    listening.ready()
    thread.join(HANG)
    assert not thread.is_alive()
    listening.close()
    dialling.close()


def test_peer_that_never_comes(directory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unix, "TIMEOUT", 0.1)
    listening = open_unix(True, ACCEPTOR, INITIATOR)
    with pytest.raises(TimeoutError):
        listening.ready()
    assert list(directory.iterdir()) == []
    dialling = open_unix(False, INITIATOR, ACCEPTOR)
    with pytest.raises(Timeout, match="the peer is silent"):
        dialling.ready()
    dialling.close()


def test_leftover_of_a_dead_process_is_replaced(directory: Path) -> None:
    (directory / "21605_47340.sock").write_text("old")
    listening, dialling = meet()
    listening.close()
    dialling.close()


def test_only_for_one_host() -> None:
    with pytest.raises(LocalProtocolError, match="use tcp"):
        open_unix(False, INITIATOR, ("10.0.0.1", 21605))


def test_no_packet_priority() -> None:
    listening, dialling = meet()
    with pytest.raises(LocalProtocolError, match="packet priority"):
        dialling.set_dscp(8)
    listening.close()
    dialling.close()


@pytest.mark.parametrize(
    ("variables", "wanted"),
    [
        ({"YARP_RUNTIME_DIR": "/r"}, "/r"),
        ({"XDG_RUNTIME_DIR": "/run/user/1"}, "/run/user/1/yarp"),
        ({"USER": "me"}, "/tmp/runtime-me/yarp"),
        ({"USER": "me", "TMPDIR": "/t"}, "/t/runtime-me/yarp"),
        ({"YARP_RUNTIME_DIR": "/r", "XDG_RUNTIME_DIR": "/x"}, "/r"),
    ],
)
def test_directory_is_where_cpp_has_it(
    variables: dict[str, str], wanted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("YARP_RUNTIME_DIR", "XDG_RUNTIME_DIR", "TMPDIR", "USER"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(unix.tempfile, "gettempdir", lambda: "/tmp")
    assert str(runtime_directory()) == wanted


@pytest.mark.skipif(bool(NO_ROOT), reason=NO_ROOT)
@pytest.mark.parametrize("whose", ["runtime-me", "runtime-me/yarp"])
def test_a_directory_of_somebody_else_is_not_used(
    whose: str, directory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Below /tmp anybody may make it first, and put sockets of their own there."""
    monkeypatch.delenv("YARP_RUNTIME_DIR")
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    monkeypatch.setenv("TMPDIR", str(directory))
    monkeypatch.setenv("USER", "me")
    (directory / whose).mkdir(parents=True)
    os.chown(directory / whose, 12345, -1)
    with pytest.raises(LocalProtocolError, match="set XDG_RUNTIME_DIR"):
        open_unix(True, ACCEPTOR, INITIATOR)
    os.chown(directory / whose, os.getuid(), -1)
    (directory / whose).chmod(0o777)  # as some umasks have it
    open_unix(True, ACCEPTOR, INITIATOR).close()
    for path in ("runtime-me", "runtime-me/yarp"):
        assert not (directory / path).stat().st_mode & 0o022


def test_a_path_that_is_too_long_is_told(directory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARP_RUNTIME_DIR", str(directory / ("x" * 100)))
    with pytest.raises(LocalProtocolError, match="set XDG_RUNTIME_DIR to a directory with a short"):
        open_unix(True, ACCEPTOR, INITIATOR)
