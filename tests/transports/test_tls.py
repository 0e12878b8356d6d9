"""TLS on a socket: bytes both ways, at once, in any size; certificates; ends."""

from __future__ import annotations

import socket
import ssl
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest
from support.timer import beating
from support.tls import prepare

from yarpy.config.authority import make
from yarpy.transports.tls import NoCertificate, TlsTransport, client_context, explained, secured

SOON = 20.0


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return prepare(tmp_path, monkeypatch)


def pair(host: str = "127.0.0.1", asks_names: bool = False) -> tuple[TlsTransport, TlsTransport]:
    """Both ends; raises what the dialling one does."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        one = socket.create_connection(server.getsockname())
        other, _ = server.accept()
    found: list[TlsTransport] = []

    def answer() -> None:
        try:
            found.append(secured(other, "", time.monotonic() + SOON, asks_names))
        except OSError:
            pass

    thread = threading.Thread(target=answer)
    thread.start()
    try:
        near = secured(one, host, time.monotonic() + SOON)
    finally:
        thread.join(SOON)
    if not found:  # who dialled hears of it with the first bytes that do not come
        with closing(near):
            near.recv_into(memoryview(bytearray(4)))
            raise ConnectionResetError
    return near, found[0]


@pytest.fixture
def ends() -> Iterator[tuple[TlsTransport, TlsTransport]]:
    both = pair()
    yield both
    for end in both:
        end.close()


def read(end: TlsTransport, size: int) -> bytes:
    found = bytearray(size)
    view = memoryview(found)
    while view:
        count = end.recv_into(view)
        assert count, "the end came early"
        view = view[count:]
    return bytes(found)


@pytest.mark.parametrize("size", [1, 100, 1 << 14, 300_001, 5 << 20])
def test_bytes_both_ways_at_once(ends: tuple[TlsTransport, TlsTransport], size: int) -> None:
    data = bytes(range(256)) * (size // 256 + 1)
    pieces = [data[: size // 3], b"", memoryview(data)[size // 3 : size]]
    said: list[threading.Thread] = []
    for end in ends:
        said.append(threading.Thread(target=end.send, args=(pieces,), daemon=True))
        said[-1].start()
    for end in ends:
        assert read(end, size) == data[:size]
    for thread in said:
        thread.join(SOON)
    assert ends[0].try_recv_into(memoryview(bytearray(9))) == -1


def test_many_threads_send_and_one_waits(ends: tuple[TlsTransport, TlsTransport]) -> None:
    one, other = ends
    heard: list[bytes] = []
    reader = threading.Thread(target=lambda: heard.append(read(one, 4)), daemon=True)
    reader.start()
    writers = [
        threading.Thread(target=lambda: [one.send([b"x" * 1000]) for _ in range(200)], daemon=True)
        for _ in range(4)
    ]
    for writer in writers:
        writer.start()
    assert read(other, 800_000) == b"x" * 800_000
    other.send([b"done"])
    reader.join(SOON)
    assert heard == [b"done"]


def test_end_is_seen(ends: tuple[TlsTransport, TlsTransport]) -> None:
    one, other = ends
    assert not one.ended()
    other.send([b"last"])
    deadline = time.monotonic() + SOON
    while not one._ahead and time.monotonic() < deadline:
        assert not one.ended()
    other.close()
    assert not one.ended()  # what came before is still to be read
    assert read(one, 4) == b"last"
    while not one.ended():
        assert time.monotonic() < deadline
    assert one.recv_into(memoryview(bytearray(4))) == 0


def test_waiting_has_a_limit(ends: tuple[TlsTransport, TlsTransport]) -> None:
    ends[0].limit_waiting(0.3)
    with beating(), pytest.raises(BlockingIOError):
        ends[0].recv_into(memoryview(bytearray(4)))
    ends[0].limit_waiting(None)
    threading.Timer(0.05, ends[0].interrupt).start()
    assert ends[0].recv_into(memoryview(bytearray(4))) == 0


def test_name_that_was_not_meant() -> None:
    with pytest.raises(ssl.SSLCertVerificationError) as caught:
        pair("robot.test")
    assert "robot.test" in explained(caught.value)


def test_authority_of_somebody_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(tmp_path / "other", ["127.0.0.1"])
    (tmp_path / "ca.pem").write_bytes((tmp_path / "other" / "ca.pem").read_bytes())
    with pytest.raises(ssl.SSLCertVerificationError) as caught:
        pair()
    assert "ca.pem" in explained(caught.value)


def test_without_a_certificate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS_DIR", str(tmp_path / "nothing"))
    with socket.socket() as sock, pytest.raises(NoCertificate, match="yarpy cert"):
        TlsTransport(sock)


def test_a_peer_without_a_certificate_hangs_up() -> None:
    """It has read nothing by then, so that the connection is reset."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        one = socket.create_connection(server.getsockname())
        other, _ = server.accept()
    other.close()
    with pytest.raises(OSError, match=r".") as caught:
        secured(one, "127.0.0.1", time.monotonic() + SOON)
    assert "`yarpy cert` makes there" in explained(caught.value)


@pytest.mark.parametrize("said", [b"GET / HTTP/1.1\r\n\r\n", b"\x16\x03\x01\xff\xff", b""])
def test_who_speaks_no_tls(said: bytes) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        one = socket.create_connection(server.getsockname())
        other, _ = server.accept()
    with one:
        one.sendall(said)
        one.shutdown(socket.SHUT_WR)
        with pytest.raises(OSError, match=r"."):
            secured(other, "", time.monotonic() + SOON)


def test_silent_one_is_not_waited_for() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        one = socket.create_connection(server.getsockname())
        other, _ = server.accept()
    with one, pytest.raises(BlockingIOError):
        secured(other, "", time.monotonic() + 0.1)


def test_both_show_certificates(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    monkeypatch.setenv("YARPY_TLS", "mutual")
    for end in pair():
        end.close()
    where = folder / "stranger"
    where.mkdir()
    (where / "ca.pem").write_bytes((folder / "ca.pem").read_bytes())
    context: Callable[[], ssl.SSLContext] = lambda: ssl.create_default_context(  # noqa: E731
        cafile=str(where / "ca.pem")
    )
    monkeypatch.setattr("yarpy.transports.tls.client_context", context)
    with pytest.raises((ssl.SSLError, ConnectionError)):
        pair()


def test_who_shows_a_certificate_is_known_by_its_names(
    monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    for asks_names, expected in ((True, ("127.0.0.1", "localhost")), (False, ())):
        one, other = pair(asks_names=asks_names)
        assert other.peer_names == expected
        assert one.peer_names == ("127.0.0.1", "localhost")  # ours, which everybody sees
        one.close()
        other.close()


def test_a_certificate_that_is_asked_for_may_be_missing(
    monkeypatch: pytest.MonkeyPatch, folder: Path
) -> None:
    context: Callable[[], ssl.SSLContext] = lambda: ssl.create_default_context(  # noqa: E731
        cafile=str(folder / "ca.pem")
    )
    monkeypatch.setattr("yarpy.transports.tls.client_context", context)
    one, other = pair(asks_names=True)
    assert other.peer_names == ()
    one.close()
    other.close()


def test_a_certificate_of_another_authority_is_no_proof(
    monkeypatch: pytest.MonkeyPatch, folder: Path, tmp_path: Path
) -> None:
    make(tmp_path / "evil", ["operator"])
    context = ssl.create_default_context(cafile=str(folder / "ca.pem"))
    context.load_cert_chain(tmp_path / "evil" / "cert.pem", tmp_path / "evil" / "key.pem")
    monkeypatch.setattr("yarpy.transports.tls.client_context", lambda: context)
    with pytest.raises((ssl.SSLError, ConnectionError)):
        pair(asks_names=True)


def test_what_finds_no_room_is_left_and_nothing_changes_places(
    ends: tuple[TlsTransport, TlsTransport],
) -> None:
    near, far = ends
    wanted = [bytes([number]) * 700_000 for number in range(12)]
    rest = near.try_send(wanted)
    while rest:  # nobody reads: at some time nothing more goes
        before, rest = rest, near.try_send(rest)
        if len(before) == len(rest) and not near.wait_writable(0.2):
            break
    assert rest[0] == b"", "it holds a part of a record back"
    size = sum(map(len, wanted))
    thread = threading.Thread(target=near.send, args=([*rest, b"the end"],))
    thread.start()
    assert read(far, size + 7) == b"".join(wanted) + b"the end"
    thread.join(SOON)
    assert near.try_send([b"more"]) == []
    assert read(far, 4) == b"more"


def test_nobody_has_to_close_a_connection_to_a_name_server(
    folder: Path, recwarn: pytest.WarningsRecorder
) -> None:
    ours, theirs = socket.socketpair()
    with theirs:
        secure = client_context().wrap_socket(
            ours, server_hostname="robot", do_handshake_on_connect=False
        )
        del secure, ours
        assert theirs.recv(1) == b"" and not recwarn.list
