"""Where sessions of Zenoh go: what users write."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from yarpy.errors import (
    AddressError,
    LocalProtocolError,
)
from yarpy.peers.zenoh.place import Place, endpoint, parts, place


@pytest.fixture(autouse=True)
def _nothing_configured(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_TLS_DIR", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", Place(("tcp/127.0.0.1:7447",))),
        ("robot", Place(("tcp/robot:7447",))),
        ("tcp/robot:7448", Place(("tcp/robot:7448",))),
        ("tls/a,b:1", Place(("tls/a:7447", "tcp/b:1"))),
        ("tcp/[::1]:7447", Place(("tcp/[::1]:7447",))),
        ("[::1]", Place(("tcp/[::1]:7447",))),
        ("tcp/a:7447#iface=eth0", Place(("tcp/a:7447#iface=eth0",))),
        ("udp/a:7447?rel=0", Place(("udp/a:7447?rel=0",))),
        ("lan", Place()),
        ("/etc/z.json5", Place(file=str(Path("/etc/z.json5")))),
        ("file:///etc/z.json5", Place(file=str(Path("/etc/z.json5")))),
    ],
)
def test_places(text: str, found: Place) -> None:
    assert place(text) == found


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows has drives")
@pytest.mark.parametrize("text", [r"C:\etc\z.json5", "C:/etc/z.json5", "file:///C:/etc/z.json5"])
def test_a_file_of_a_drive(text: str) -> None:
    assert place(text) == Place(file=r"C:\etc\z.json5")


@pytest.mark.parametrize("text", ["tcp/", "ftp/a:1", "a:b", "a:70000", "a/b/c", "::1", "tcp/a:-1"])
def test_no_places(text: str) -> None:
    with pytest.raises(AddressError, match="YARPY_ZENOH"):
        endpoint(text)


def test_the_environment_says_where(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_ZENOH", "tls/robot.lab")
    assert place() == Place(("tls/robot.lab:7447",))
    assert place("tcp/other") == Place(("tcp/other:7447",))


def test_where_tls_is_required_there_is_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_TLS", "require")
    assert place("robot") == Place(("tls/robot:7447",))
    for text in ("tcp/robot", "lan", "udp/robot:1"):
        with pytest.raises(LocalProtocolError, match="YARPY_TLS requires TLS"):
            place(text)


def test_the_parts_of_an_address() -> None:
    assert parts("tcp/robot:7447#iface=eth0") == ("tcp", "robot", "7447")
    assert parts("udp/[::1]:1?rel=0") == ("udp", "::1", "1")
    assert parts("") == ("", "", "") and parts("tcp/x") == ("tcp", "", "x")
