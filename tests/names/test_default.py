"""Which name service is used when a port is not told."""

import socket
import threading

import pytest
from support.port import free_port
from support.wait import HANG

import yarpy
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.default import DefaultNames, own_host, prove, secret
from yarpy.names.fallback_client import SeveralNames
from yarpy.nameserver.local import LocalNames


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """No configuration but what a test writes."""
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    for name in ("YARPY_SERVER", "YARP_NAMESPACE", "YARP_IP", "YARP_PORT_RANGE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_nothing_configured_is_an_error_that_says_what_to_do():
    with pytest.raises(NoNameServer, match="yarpy server"):
        DefaultNames().current()
    with pytest.raises(NoNameServer, match="LocalNames"):
        yarpy.Port("/nowhere")


def test_the_innermost_open_service_wins_whatever_order_they_close_in():
    names, first, second = DefaultNames(), LocalNames(), LocalNames()
    names.push(first)
    names.push(second)
    assert names.current() is second
    names.pop(first)
    assert names.current() is second
    names.pop(second)
    with pytest.raises(NoNameServer):
        names.current()


def test_the_files_are_read_again_when_they_change(place):
    names = DefaultNames()
    (place / "yarp.conf").write_text("127.0.0.1 10101 yarp\n")
    first = names.current()
    assert (first.host, first.port) == ("127.0.0.1", 10101)
    assert names.current() is first
    (place / "yarp.conf").write_text("127.0.0.1 10102 yarp\n")
    assert names.current().port == 10102


def test_the_variable_overrides_the_files_and_may_name_several(place, monkeypatch):
    (place / "yarp.conf").write_text("127.0.0.1 10101 yarp\n")
    monkeypatch.setenv("YARPY_SERVER", "localhost:1234,127.0.0.1:1235")
    found = DefaultNames().current()
    assert isinstance(found, SeveralNames)
    assert [client.port for client in found.clients] == [1234, 1235]


def test_a_local_address_is_chosen_by_its_beginning(monkeypatch):
    assert own_host() == ""
    monkeypatch.setenv("YARP_IP", "127.")
    assert own_host().startswith("127.")
    monkeypatch.setenv("YARP_IP", "203.0.113.")
    assert own_host() == ""


def test_the_key_comes_from_auth_conf_and_a_file_without_one_is_an_error(place):
    assert secret() == b""
    (place / "auth.conf").write_text('[AUTH]\nkey "two words"\n')
    assert secret() == b"two words"
    (place / "auth.conf").write_text("nothing here\n")
    with pytest.raises(AddressError, match=r"auth\.conf has no key"):
        secret()


def test_ports_and_a_server_that_share_a_key_talk_and_others_are_refused(place):
    (place / "auth.conf").write_text("[AUTH]\nkey sesame\n")
    with (
        yarpy.NameServer() as server,
        yarpy.Port("/safe/out") as writer,
        yarpy.Port("/safe/in") as reader,
    ):
        writer.connect("/safe/in")
        writer.write(["hello"])
        assert reader.read(timeout=HANG).value == ["hello"]
        with socket.create_connection((server.host, server.port), 5) as stranger:
            stranger.settimeout(5)
            assert len(stranger.recv(40, socket.MSG_WAITALL)) == 40
            stranger.sendall(bytes(40))
            assert stranger.recv(1) == b""


def test_proving_stops_at_the_last_byte_of_the_proof(place):
    """What the other side says after it belongs to the connection's own protocol."""
    from yarpy.carriers.auth import prove_acceptor
    from yarpy.wire.stream import ByteStream

    (place / "auth.conf").write_text("[AUTH]\nkey sesame\n")
    ours, theirs = socket.socketpair()

    def accept():
        stream = ByteStream()
        steps = prove_acceptor(stream, b"sesame")
        next(steps)
        theirs.sendall(b"".join(stream.take_output()))
        stream.feed(theirs.recv(40, socket.MSG_WAITALL))
        with pytest.raises(StopIteration):
            next(steps)
        theirs.sendall(b"".join(stream.take_output()) + b"Welcome")

    thread = threading.Thread(target=accept)
    thread.start()
    with ours, theirs:
        ours.settimeout(5)
        prove(ours)
        assert ours.recv(7, socket.MSG_WAITALL) == b"Welcome"
        thread.join(HANG)


def test_a_server_that_is_gone_is_an_error_that_names_its_address(monkeypatch):
    number = free_port()
    monkeypatch.setenv("YARPY_SERVER", f"127.0.0.1:{number}")
    with pytest.raises(NoNameServer, match=str(number)):
        yarpy.Port("/nowhere")
