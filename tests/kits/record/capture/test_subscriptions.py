"""Ports that come, go, come back, and that nobody should hear."""

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AddressError, LocalProtocolError
from yarpy.kits.record.capture.subscriptions import PortSelection, Subscriptions, can_be_heard


@pytest.fixture
def names():
    with yarpy.NameServer() as server:
        yield server.client


@pytest.fixture
def port(names):
    with yarpy.BufferedPort("/recorder", callback=lambda message: None, names=names) as port:
        yield port


def sources(port: yarpy.BufferedPort) -> set[str]:
    return {link.source for link in port.inputs}


def test_which_ports() -> None:
    assert PortSelection(every=True, exclude="^/log/").matches("/cam")
    assert not PortSelection(every=True, exclude="^/log/").matches("/log/x")
    assert PortSelection(pattern="cam").matches("/icub/cam/left")
    assert not PortSelection(pattern="^cam").matches("/icub/cam/left")
    assert not PortSelection(("/a",)).searching and not PortSelection(("/a",)).matches("/a")
    with pytest.raises(LocalProtocolError, match=r"is no regular expression: .*; all below"):
        PortSelection(pattern="(")
    known = ("topic://a", "/127.0.0.1:10002", "/topic@/node")
    assert PortSelection(known).names == known
    for never in ("", "cam", "/a b"):
        with pytest.raises(AddressError, match="port name"):
            PortSelection((never,))


def test_a_port_that_comes_and_comes_back(names, port) -> None:
    told: list[str] = []
    following = Subscriptions(port, PortSelection(("/late",)), names=names, tell=told.append)
    try:
        wait_until(lambda: told)
        assert told == ["/late is not there yet: it is recorded when it comes"]
        assert following.waiting == ["/late"]
        for _ in range(2):
            with yarpy.Port("/late", names=names) as late:
                assert late.wait_for_outputs(timeout=HANG)
                wait_until(lambda: following.waiting == [])
            wait_until(lambda: not port.inputs)
    finally:
        following.close()


def test_what_matches_and_is_not_of_rpc(names, port) -> None:
    with (
        yarpy.Port("/robot/a", names=names) as a,
        yarpy.Port("/robot/log", names=names),
        yarpy.Port("/other", names=names),
        yarpy.RpcServer("/robot/rpc", lambda line: line, names=names),
        yarpy.RpcClient("/robot/rpc", name="/robot/asks", names=names) as client,
    ):
        assert can_be_heard("/robot/a", names)
        assert not can_be_heard("/robot/rpc", names) and not can_be_heard("/robot/asks", names)
        following = Subscriptions(
            port, PortSelection(pattern="^/robot", exclude="log"), names=names
        )
        try:
            wait_until(lambda: sources(port) == {"/robot/a"})
            with yarpy.Port("/robot/b", names=names):
                wait_until(lambda: sources(port) == {"/robot/a", "/robot/b"})
                assert len(a.outputs) == 1 and len(client.outputs) == 1
        finally:
            following.close()


def test_all_but_the_recorder_and_the_name_server(names, port) -> None:
    with yarpy.Port("/a", names=names), yarpy.Port("/b", names=names):
        following = Subscriptions(port, PortSelection(every=True), names=names)
        try:
            wait_until(lambda: sources(port) == {"/a", "/b"})
            with yarpy.Port("/c", names=names):
                wait_until(lambda: sources(port) == {"/a", "/b", "/c"})
        finally:
            following.close()


def test_a_name_server_that_goes(port) -> None:
    told: list[str] = []
    with yarpy.NameServer() as server:
        names = server.client
    following = Subscriptions(port, PortSelection(("/a",)), names=names, tell=told.append)
    try:
        wait_until(lambda: told)
        assert told[0].startswith("no name server answers, what is connected is recorded")
    finally:
        following.close()
