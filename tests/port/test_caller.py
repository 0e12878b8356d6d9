"""Caller against real ports on the loopback."""

import pytest

import yarpy
from yarpy.port.caller import Caller

HERE = "127.0.0.1"


@pytest.fixture
def names():
    return yarpy.LocalNames()


def test_asks_again_and_again_over_one_connection(names):
    sources = []

    def answer(message):
        sources.append(message.source)
        return ["ok", *message.value]

    with (
        yarpy.RpcServer("/server", answer, names=names) as server,
        Caller(server.contact) as caller,
    ):
        first = caller.ask(["add", 1, 2], timeout=5)
        second = caller.ask(["x"], timeout=5)
        assert first is not None and first.value == ["ok", "add", 1, 2]
        assert second is not None and second.value == ["ok", "x"]
        assert sources == ["anon_rpc", "anon_rpc"]
        assert [link.source for link in server.inputs] == ["anon_rpc"]


def test_has_the_name_it_is_given_and_any_carrier_with_replies(names):
    with (
        yarpy.RpcServer("/server", lambda message: [message.source], names=names) as server,
        Caller(server.contact, "/me", carrier="text_ack") as caller,
    ):
        reply = caller.ask(["who"], timeout=5)
        assert reply is not None and reply.value == ["/me"]


def test_asks_the_administrative_side(names):
    with (
        yarpy.RpcServer("/server", lambda message: ["data"], names=names) as server,
        Caller(server.contact, admin=True) as caller,
    ):
        reply = caller.ask([yarpy.Vocab("ver")], timeout=5)
        assert reply is not None and reply.value == ["ver", 1, 2, 3]


def test_closing_ends_the_connection_in_good_order(names):
    reports = []
    with yarpy.Port("/reader", names=names, callback=lambda message: None) as port:
        port.on_connection(reports.append)
        caller = Caller(port.contact, "/me")
        assert port.wait_for_inputs(timeout=5)
        caller.close()
        assert _wait(lambda: len(reports) == 2)
        assert (reports[-1].created, reports[-1].reason) == (False, "")


def test_a_carrier_without_replies_is_refused(names):
    with (
        yarpy.RpcServer("/server", lambda message: [], names=names) as server,
        pytest.raises(yarpy.LocalProtocolError, match="udp"),
    ):
        Caller(server.contact, carrier="udp")


def test_nobody_there():
    with pytest.raises(yarpy.LinkClosed):
        Caller(yarpy.Contact("tcp", "/gone", HERE, 1), timeout=2)


def test_a_port_that_goes_away_is_an_error_of_ours(names):
    server = yarpy.RpcServer("/server", lambda message: ["ok"], names=names)
    caller = Caller(server.contact)
    assert caller.ask([1], timeout=5) is not None
    server.close()
    with pytest.raises(yarpy.LinkClosed):
        caller.ask([2], timeout=5)


def _wait(condition, timeout=5.0):
    import time

    deadline = time.monotonic() + timeout
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.01)
    return condition()
