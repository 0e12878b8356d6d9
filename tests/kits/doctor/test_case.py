"""What the doctor knows."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest
from support.doctor import made_up
from support.wait import wait_until

import yarpy
from yarpy.errors import NoNameServer
from yarpy.kits.doctor.case import Case
from yarpy.network.traffic import End, Flow


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


def test_growth_between_two_looks() -> None:
    case = made_up(
        Flow("/a", "/b", End("tcp", 5, waiting=1), None),
        Flow("/a", "/b", End("tcp", 9, waiting=None), End("tcp")),
    )
    [pair] = case.pairs
    assert (pair.name, pair.carrier) == ("/a -> /b", "tcp")
    assert pair.grown("sender", "messages") == 4
    assert pair.grown("sender", "waiting") is None
    assert pair.grown("receiver", "messages") is None
    assert case.pair("/b", "/a").now is None


def test_a_port_and_its_peers(names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names),
        yarpy.BufferedPort("/c", names=names) as c,
    ):
        a.connect("/b")
        c.connect("/a")
        c.connect("/b")
        wait_until(lambda: a.inputs)
        case = Case("/a", names=names, window=0.01)
        assert set(case.ports) == {"/a", "/b", "/c"}
        assert {pair.name for pair in case.pairs} == {"/a -> /b", "/c -> /a"}
        assert case.dialect("/b") == 3
        assert case.who("/b") == "/b"
        assert case.peek("/a").kind == ""


def test_names_may_be_typed_carelessly(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/a", names=names) as a:
        address = f"{a.contact.host}:{a.contact.port}"
        assert Case("a", address, names=names, window=0.01).wanted == ("/a", "/a")


def test_a_name_server_that_is_silent(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    monkeypatch.setattr("yarpy.kits.doctor.case.SERVER_TIMEOUT", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        client = yarpy.YarpNameClient("127.0.0.1", silent.getsockname()[1])
        case = Case("/a", "/b", names=client)
        assert isinstance(case.problem, NoNameServer)
        assert case.pairs[0].now is None


def test_a_broken_file_is_a_problem(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    monkeypatch.delenv("YARPY_SERVER", raising=False)
    (tmp_path / "yarp.conf").write_text("here 10000 sideways")
    assert "sideways" in str(Case("/a").problem)
