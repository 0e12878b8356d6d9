"""All connections of a network."""

from __future__ import annotations

import socket

from support.wait import wait_until

import yarpy
from yarpy.network.traffic import End, Flow, flows, read


def test_every_connection_once_as_both_ends_see_it() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names) as b,
        yarpy.RpcServer("/s", lambda message: message.value, names=names),
        yarpy.RpcClient("/s", name="/c", names=names) as client,
    ):
        a.connect("/b", "udp")
        for number in range(5):
            a.write([number])
        client.call("hello")
        wait_until(lambda: b.inputs and b.inputs[0].stats["messages"] == 5)
        found = {(flow.source, flow.target): flow for flow in flows(names)}
        assert [*found] == [("/a", "/b"), ("/c", "/s")]
        flow = found["/a", "/b"]
        assert flow.carrier == "udp"
        assert flow.sender is not None
        assert flow.receiver is not None
        assert (flow.sender.messages, flow.receiver.messages) == (5, 5)
        assert flow.drops == flow.receiver.drops
        assert flow.measured("rate") > 0
        assert found["/c", "/s"].measured("latency") > 0


def test_ports_that_do_not_answer_have_no_connections() -> None:
    names = yarpy.LocalNames()
    with socket.create_server(("127.0.0.1", 0)) as silent, yarpy.Port("/a", names=names):
        names.register("/silent", "tcp", "127.0.0.1", silent.getsockname()[1])
        names.register("/dead", "tcp", "127.0.0.1", 9)
        names.register("/camera", "mjpeg", "127.0.0.1", 9)
        assert flows(names) == []


def test_what_nobody_counts_is_none() -> None:
    flow = Flow("/a", "/b", End("tcp"), None)
    assert (flow.drops, flow.measured("messages"), flow.carrier) == (None, None, "tcp")
    assert read(yarpy.Property(source="/a", target="/b"))[2] == End()
