"""Targets: what they say, and what is wrong with them."""

from __future__ import annotations

import pytest
from support.port import free_port

import yarpy
from yarpy.errors import AddressError, LinkClosed, LocalProtocolError
from yarpy.names.default import DEFAULT
from yarpy.peers.zenoh.medium import check_key


def test_keys() -> None:
    assert check_key("/robot/arm") == check_key("robot/arm") == "robot/arm"
    assert check_key("/icub/head/state:o") == "icub/head/state:o"
    assert check_key("/robot/**/x", patterns=True) == "robot/**/x"


@pytest.mark.parametrize(
    "key", ["", "/", "a//b", "a/", "a/*", "a/**", "a$*b", "a?b", "a#b", "@a/b", "a/@b", "x" * 5000]
)
def test_what_is_no_key(key: str) -> None:
    with pytest.raises(AddressError, match="no key of Zenoh"):
        check_key(key)


@pytest.mark.parametrize("key", ["**/**", "a*", "***", "a/@x/*"])
def test_what_is_no_pattern(key: str) -> None:
    with pytest.raises(AddressError, match="no key of Zenoh"):
        check_key(key, patterns=True)


def test_a_router_is_no_part_of_a_key() -> None:
    with pytest.raises(AddressError, match=r"zenoh://arm; .* YARPY_ZENOH=tcp/robot.lab:7447"):
        check_key("/robot.lab:7447/arm")


def test_no_router(names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
    monkeypatch.setenv("YARPY_ZENOH", f"tcp/127.0.0.1:{free_port()}")
    with yarpy.Port("/out") as out:
        with pytest.raises(LinkClosed, match="no Zenoh router answers"):
            out.connect("zenoh://robot/arm")
        assert out.stats.outputs == []


def test_the_router_where_names_are(router: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARPY_ZENOH")
    names = yarpy.zenoh.ZenohNames(router)
    DEFAULT.push(names)
    try:
        with yarpy.Port("/out") as out:
            out.connect("zenoh://robot/arm")
            assert [one.target for one in out.stats.outputs] == ["/zenoh://robot/arm"]
    finally:
        DEFAULT.pop(names)
        names.close()


def test_two_ports_are_not_connected_over_it(names: yarpy.LocalNames) -> None:
    refused = pytest.raises(LocalProtocolError, match="zenoh leads to what is no port")
    with yarpy.Port("/out"), yarpy.BufferedPort("/in"), refused:
        yarpy.connect("/out", "/in", "zenoh")


@pytest.mark.parametrize("carrier", ["zenoh", "zenoh+raw", "ros2", "ros2+qos.sensor", "ros2+dds"])
def test_a_port_connects_itself_to_no_port_over_it(carrier: str, names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in") as reader:
        why = "leads to what is no port: one end is"
        for ask in (out.connect, reader.listen_to):
            with pytest.raises(LocalProtocolError, match=why):
                ask("/in" if ask == out.connect else "/out", carrier)
        answer = yarpy.admin("/out", yarpy.Vocab("add"), "/in", carrier)
        assert answer[0] == -1
        assert why in answer[1]
        assert not out.outputs


@pytest.mark.parametrize("target", ["zenoh://in", "ros2://in", "mqtt://127.0.0.1:1/in"])
def test_another_carrier_than_the_target_says_is_refused(
    target: str, names: yarpy.LocalNames
) -> None:
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in"):
        for ask in (out.connect, out.listen_to):
            with pytest.raises(LocalProtocolError, match="conflict between tcp and"):
                ask(target, "tcp")
        answer = yarpy.admin("/out", yarpy.Vocab("add"), target, "tcp")
        assert answer[0] == -1
        assert "conflict between tcp and" in answer[1]
        assert not out.outputs


def test_what_is_added_by_the_carrier_counts(router: str, names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out") as out:
        out.connect("zenoh://robot/arm", "zenoh+raw")
        assert [one.route.carrier for one in out._hub.outputs.links] == ["zenoh+raw"]
