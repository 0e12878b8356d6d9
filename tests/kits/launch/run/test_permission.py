"""Who may start programs: the user whose server it is, and who proves that he was given the right.

Another user is made where we may become one; a stranger comes from an address that proves nothing.
"""

import os
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from support.system import NO_RUN_SERVER
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AccessRefused
from yarpy.kits.launch.run import permission
from yarpy.kits.launch.run.allowed import Allowed
from yarpy.kits.launch.run.client import RunClient
from yarpy.kits.launch.run.permission import RunGate, user_of
from yarpy.link.begin.admission import ASK, Peer
from yarpy.nameserver.local import LocalNames

pytestmark = pytest.mark.skipif(bool(NO_RUN_SERVER), reason=NO_RUN_SERVER)


FAR = Peer("192.168.1.9")


def why(peer: Peer, listed: bool = True) -> str:
    admission = RunGate("/node", listed).admit(peer)
    assert admission.allows(ASK)
    return admission.refusal("write")


@pytest.fixture
def rules(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "access.toml"
    monkeypatch.setenv("YARPY_ACCESS", str(path))
    return path


def test_strangers_are_told_who_may() -> None:
    assert "only its owner on that computer may" in why(FAR)
    assert "yarpy access allow run tls:operator" in why(Peer("10.0.0.1", names=("operator",)))
    assert "yarpy access allow run key" in why(Peer("10.0.0.1", key=True))


def test_an_address_in_the_rules_proves_nothing(rules: Path) -> None:
    rules.write_text('[[allow]]\nwho = "anyone"\nmay = ["all", "run"]\n', encoding="utf-8")
    assert "certificate" in why(FAR)
    assert why(Peer("10.0.0.1", names=("operator",))) == ""
    assert "--allow PROGRAM" in why(Peer("10.0.0.1", key=True), listed=False)


def test_all_rights_do_not_hold_that_one(rules: Path) -> None:
    rules.write_text('[[allow]]\nwho = "tls:operator"\nmay = "all"\n', encoding="utf-8")
    assert "yarpy access allow run" in why(Peer("10.0.0.1", names=("operator",)))


def test_whose_program_is_at_the_other_end() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        caller = socket.create_connection(listener.getsockname())
        answered, _ = listener.accept()
        with answered:
            peer = Peer("127.0.0.1", True, ends=(caller.getsockname(), listener.getsockname()))
            if sys.platform != "linux":
                assert user_of(peer) is None  # and so nobody is believed
                caller.close()
                return
            assert user_of(peer) == os.geteuid() and why(peer) == ""
            caller.close()  # what nobody holds any more shows the number of root
            assert user_of(peer) is None and "another user" in why(peer)
    assert user_of(Peer("127.0.0.1", True)) is None
    assert user_of(Peer("x", True, ends=(("x", 1), ("::1", 2)))) is None


def test_where_nobody_tells_whose_program_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(permission, "_TABLES", ())
    here = Peer("127.0.0.1", True, ends=(("127.0.0.1", 1), ("127.0.0.1", 2)))
    assert "unlike Linux, does not tell" in why(here)
    assert "only its owner on that computer may" in why(FAR)
    assert "nobody yet" in permission.audience(False)
    assert permission.audience(True) == "those who may by access.toml"


# What anybody can type into telnet.
ASKS = r"""
exec 3<>"/dev/tcp/$1/$2"
printf 'CONNECT me\r\nd\r\n(cmd "touch %s") (as evil)\r\n' "$3" >&3
while read -r -t 30 line <&3; do
    echo "$line"
    case "$line" in *refused*) break;; esac
done
"""


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="needs root's rights")
@pytest.mark.parametrize("user", [65534, 0])
def test_another_user_of_this_computer_starts_nothing(
    node: RunClient, user: int, tmp_path: Path
) -> None:
    made = tmp_path / "made"
    host, port = _address(node)
    with subprocess.Popen(
        ["/bin/bash", "-c", ASKS, "asks", host, str(port), str(made)],
        stdout=subprocess.PIPE,
        text=True,
        user=user,
        cwd="/",
    ) as asking:
        assert asking.stdout is not None
        if user:
            assert "another user" in asking.stdout.read()
            assert not made.exists() and node.running() == []
        else:
            wait_until(made.exists)
            asking.kill()


def _address(node: RunClient) -> tuple[str, int]:
    found = node._client._hub.names
    assert found is not None
    contact = found.query("/node")
    assert contact is not None
    return contact.host, contact.port


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1", None])
def test_a_web_page_starts_nothing(node: RunClient, origin: str | None) -> None:
    """Whatever it says of itself: the browser is a program of the owner."""
    host, port = _address(node)
    asked = [(path, None) for path in ("/", "/?data=", "/?req=(cmd+sleep)+(as+x)")]
    for path, data in (("/", b"data=(cmd sleep) (as x)"), *asked):
        request = urllib.request.Request(f"http://{host}:{port}{path}", data)
        if origin is not None:
            request.add_header("Origin", origin)
        with pytest.raises((urllib.error.HTTPError, ConnectionError)) as refused:
            urllib.request.urlopen(request, timeout=HANG)
        if isinstance(refused.value, urllib.error.HTTPError):
            refused.value.close()
    assert node.running() == []


def test_a_websocket_starts_nothing(node: RunClient) -> None:
    host, port = _address(node)
    with socket.create_connection((host, port)) as line:
        line.settimeout(HANG)
        line.sendall(
            b"GET /?ws HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
        )
        assert b" 101 " not in line.recv(1000)
    assert node.running() == []


def test_the_owner_may(node: RunClient) -> None:
    assert node.start("a", ["sleep", "60"]).pid > 0
    assert [one.tag for one in node.running()] == ["a"]


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells whose program asks")
def test_a_list_is_for_the_owner_as_well(serve, names: LocalNames) -> None:
    serve(allowed=Allowed(["sleep"]))
    with RunClient("/node", names=names) as node:
        with pytest.raises(AccessRefused, match="--allow"):
            node.start("a", ["sh", "-c", "exit"])
        assert node.start("b", ["sleep", "60"]).pid > 0
    assert yarpy.AccessRefused is AccessRefused
