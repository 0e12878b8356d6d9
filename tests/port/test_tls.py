"""Connections in TLS between ports, for browsers and tools; what is on the way cannot be read."""

from __future__ import annotations

import socket
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
from support.peer import program
from support.tls import prepare
from support.wait import HANG, wait_until

import yarpy

SECRET = "the-angle-of-the-left-elbow"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return prepare(tmp_path, monkeypatch)


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@contextmanager
def recording(port: int) -> Iterator[tuple[int, bytearray, list[bool]]]:
    """A number that leads to `port`, all bytes that passed, both ways, and an item for each
    connection that is over."""
    seen, over = bytearray(), []

    def pump(one: socket.socket, other: socket.socket) -> None:
        try:
            while data := one.recv(1 << 16):
                seen.extend(data)
                other.sendall(data)
        except OSError:
            pass
        try:
            other.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # it has gone

    def serve(near: socket.socket) -> None:
        address = ("127.0.0.1", port)
        # The port may be closed by then.
        with near, suppress(ConnectionRefusedError), socket.create_connection(address) as far:
            back = threading.Thread(target=pump, args=(far, near), daemon=True)
            back.start()
            pump(near, far)
            back.join()
        over.append(True)

    def accept() -> None:
        while True:
            try:
                near, _ = server.accept()
            except OSError:
                return
            threading.Thread(target=serve, args=(near,), daemon=True).start()

    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=accept, daemon=True).start()
        yield server.getsockname()[1], seen, over
        with suppress(OSError):  # on Windows closing it wakes, and this is refused
            server.shutdown(socket.SHUT_RDWR)


@pytest.mark.parametrize(
    ("carrier", "seen"),
    [
        ("tls", "tcp+tls"),
        ("tcp+tls", "tcp+tls"),
        ("fast_tcp+tls", "fast_tcp+tls"),
        ("text_ack+tls", "text_ack+tls"),
        ("websocket+tls", "websocket+tls"),
        ("http+tls", "http+tls"),
    ],
)
def test_nothing_of_a_message_can_be_read_on_the_way(
    names: yarpy.LocalNames, carrier: str, seen: str
) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        for secure in (False, True):
            plain = carrier.removesuffix("+tls").replace("tls", "tcp")
            with recording(in_.contact.port) as (number, passed, _):
                out.connect(f"/127.0.0.1:{number}", carrier if secure else plain)
                for value in ([SECRET, 1], [SECRET, "x" * 300_000]):
                    out.write(value)
                    message = in_.read(timeout=HANG)
                    assert message is not None
                    assert message.value == value
                if secure:
                    assert in_.inputs[0].carrier == seen
                out.disconnect(f"/127.0.0.1:{number}")
                wait_until(lambda: not in_.inputs)
            assert (SECRET.encode() in passed) == (not secure)
            assert not (secure and b"/out" in passed)


def test_nor_what_is_asked_about_a_connection(names: yarpy.LocalNames) -> None:
    with (
        yarpy.BufferedPort("/in", names=names) as in_,
        yarpy.Port("/out", names=names) as out,
        recording(in_.contact.port) as (number, passed, over),
    ):
        out.connect(f"/127.0.0.1:{number}", "websocket+tls")
        wait_until(lambda: over)  # who is it?
        out.write(1)
        # How much came? Also asked while the connection is new, and again a second later.
        wait_until(lambda: len(over) >= 2)
        assert b"/out" not in passed
        assert b"CONNACK" not in passed


def test_questions_and_pictures(names: yarpy.LocalNames) -> None:
    with (
        yarpy.RpcServer("/server", lambda m: m.value, names=names),
        yarpy.RpcClient(names=names) as client,
    ):
        client.connect("/server", "tls")
        assert client.call(SECRET) == [SECRET]
    picture = yarpy.Image(np.full((48, 64, 3), 200, np.uint8))
    with (
        yarpy.BufferedPort("/camera", names=names) as camera,
        yarpy.BufferedPort("/viewer", names=names) as viewer,
    ):
        viewer.connect("/camera", "mjpeg+tls")
        assert camera.wait_for_outputs(1, 10)
        camera.write(picture)
        message = viewer.read(timeout=HANG)
        assert message is not None
        assert message.as_(yarpy.Image).width == 64


@pytest.mark.parametrize("carrier", ["udp+tls", "mcast+tls"])
def test_datagrams_are_not_protected(names: yarpy.LocalNames, carrier: str) -> None:
    with (
        yarpy.Port("/in", names=names),
        yarpy.Port("/out", names=names) as out,
        pytest.raises(yarpy.YarpError, match="TLS protects no datagrams"),
    ):
        out.connect("/in", carrier)


def test_peer_does_not_say_what_only_we_can_see(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/in", names=names) as in_, socket.socket() as peer:
        peer.connect(("127.0.0.1", in_.contact.port))
        peer.sendall(b"CONNECT /liar (tls) (x 1)\r\n")
        wait_until(lambda: in_.inputs)
        assert in_.inputs[0].carrier == "text+x.1"


def test_a_port_may_insist(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        monkeypatch.setenv("YARPY_TLS", "require")
        out.connect("/in")  # of its own accord
        wait_until(lambda: in_.inputs)
        assert in_.inputs[0].carrier == "tcp+tls"
        out.write([1])
        assert in_.read(timeout=HANG)
        with socket.create_connection(("127.0.0.1", in_.contact.port)) as plain:
            plain.sendall(b"CONNECT /me\r\n")
            assert b"TLS alone" in plain.recv(1000)
        wait_until(lambda: "without TLS" in caplog.text)


def test_name_server_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS", "require")
    with yarpy.NameServer() as server, yarpy.Port("/in") as in_, yarpy.Port("/out") as out:
        assert server.client.query("/in") == in_.contact
        out.connect("/in")
        out.write([SECRET])
        message = in_.read(timeout=HANG)
        assert message is not None
        assert message.value == [SECRET]


def test_with_a_shared_key_as_well(names: yarpy.LocalNames, tmp_path: Path,
                                   monkeypatch: pytest.MonkeyPatch) -> None:  # fmt: skip
    monkeypatch.setattr("yarpy.port.keep.registration.secret", lambda: b"the key")
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        for carrier in ("tls", "tcp"):
            out.connect("/in", carrier)
            out.write([carrier])
            message = in_.read(timeout=HANG)
            assert message is not None
            assert message.value == [carrier]


def test_certificate_of_somebody_else(names: yarpy.LocalNames, folder: Path) -> None:
    from yarpy.config.authority import make

    with yarpy.Port("/in", names=names), yarpy.Port("/out", names=names) as out:
        make(folder / "other", ["127.0.0.1"])
        (folder / "ca.pem").write_bytes((folder / "other" / "ca.pem").read_bytes())
        with pytest.raises(yarpy.RemoteProtocolError, match=r"certificate is not valid"):
            out.connect("/in", "tls")


# -- tools ----------------------------------------------------------------------------------------


@pytest.mark.peer("curl")
def test_curl(names: yarpy.LocalNames, folder: Path) -> None:
    with yarpy.RpcServer("/server", lambda m: [*m.value, "heard"], names=names) as server:
        url = f"https://{server.address}"

        def curl(*words: str) -> str:
            line = [
                program("curl"),
                "-sS",
                "--noproxy",
                "*",
                "--cacert",
                str(folder / "ca.pem"),
                *words,
            ]
            done = subprocess.run(line, capture_output=True, text=True, timeout=HANG, check=False)
            return done.stdout + done.stderr

        assert curl(f"{url}/?req=hello") == '["hello", "heard"]\n'
        assert curl("-H", f"Origin: {url}", f"{url}/?req=hello") == '["hello", "heard"]\n'
        assert "only the port's own page" in curl("-H", "Origin: http://evil", f"{url}/?req=x")
        assert "only the port's own page" in curl(
            "-H", f"Origin: http://{server.address}", f"{url}/?req=x"
        )
        assert "certificate" in curl("--cacert", "/etc/ssl/certs/none.pem", f"{url}/").lower()


@pytest.mark.peer("openssl")
def test_openssl(names: yarpy.LocalNames, folder: Path) -> None:
    with yarpy.Port("/in", names=names) as in_:
        line = [program("openssl"), "s_client", "-quiet",
                "-verify_return_error", "-verify_ip", "127.0.0.1",
                "-CAfile", str(folder / "ca.pem"), "-connect", in_.address]  # fmt: skip
        with subprocess.Popen(
            line, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        ) as process:
            assert process.stdin is not None
            process.stdin.write(b"CONNECT /person\r\nD\r\nhello 1\r\n")
            process.stdin.flush()
            message = in_.read(timeout=HANG)
            assert message is not None
            assert message.value == ["hello", 1]
            process.kill()


@pytest.mark.peer("curl")
def test_protocols_that_turn_into_another_stay_in_tls(
    names: yarpy.LocalNames, folder: Path
) -> None:
    with yarpy.RpcServer("/server", lambda m: m.value, names=names) as server:
        url = f"https://{server.address}/"
        line = [program("curl"), "-sS", "--noproxy", "*", "--cacert", str(folder / "ca.pem"),
                "-H", f"Origin: {url[:-1]}", "-d", "data=hello", url]  # fmt: skip
        done = subprocess.run(line, capture_output=True, text=True, timeout=HANG, check=False)
        assert "hello" in done.stdout, done.stdout + done.stderr
