"""`prop get` and `prop set`: processes, threads, priorities of connections."""

from __future__ import annotations

import os
import socket
import threading

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import BufferedPort, Port
from yarpy.port.rpc import RpcClient, RpcServer


def admin(names: LocalNames, name: str, text: str) -> Bottle:
    return network.admin(name, *Bottle.from_text(text), names=names)


def group(reply: Bottle, key: str) -> dict[str, object]:
    """One group of a reply; over text its dict has become a list of pairs."""
    return dict(reply.find(key))


def may_schedule() -> bool:
    """Whether the system lets a thread of ours have SCHED_FIFO."""
    allowed: list[bool] = []

    def attempt() -> None:
        try:
            os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(5))
            allowed.append(True)
        except (OSError, AttributeError):
            allowed.append(False)

    thread = threading.Thread(target=attempt)
    thread.start()
    thread.join()
    return allowed[0]


def test_what_a_port_says_of_itself(names: LocalNames) -> None:
    with Port("/it", names=names, port_type="image") as port:
        reply = admin(names, "/it", "prop get /it")
        sched = group(reply, "sched")
        assert sched["tid"] in {t.native_id for t in threading.enumerate()}
        process = group(reply, "process")
        assert process["pid"] == os.getpid()
        assert len(str(process["arguments"])) <= 256
        assert group(reply, "platform")["hostname"] == port.contact.host
        assert group(reply, "port") == {
            "is_input": 1,
            "is_output": 1,
            "is_rpc": 0,
            "type": "image",
        }


@pytest.mark.parametrize(
    ("kind", "flags"), [("server", (1, 0, 0)), ("client", (1, 1, 1)), ("buffered", (1, 1, 0))]
)
def test_kinds_of_ports(kind: str, flags: tuple[int, int, int], names: LocalNames) -> None:
    made = {
        "server": lambda: RpcServer("/it", lambda m: None, names=names),
        "client": lambda: RpcClient(name="/it", names=names),
        "buffered": lambda: BufferedPort("/it", names=names),
    }[kind]
    with made():
        found = group(admin(names, "/it", "prop get /it"), "port")
        assert (found["is_input"], found["is_output"], found["is_rpc"]) == flags


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_packet_priority_reaches_the_socket(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        for name, peer, port in (("/out", "/in", out), ("/in", "/out", in_)):
            for words, tos in (
                ("priority HIGH", 144),
                ("dscp AF12", 48),
                ("dscp 10", 40),
                ("tos 12", 12),
            ):
                reply = admin(names, name, f"prop set {peer} (qos (({words})))")
                assert reply == [Vocab("ok")]
                links = port._hub.outputs.links or port._hub.inputs.links
                sock = links[0].driver.transport.sock  # type: ignore[attr-defined]
                assert sock.getsockopt(socket.IPPROTO_IP, socket.IP_TOS) == tos
                assert group(admin(names, name, f"prop get {peer}"), "qos") == {"tos": tos}


REFUSED = [
    "prop set /in (qos ((priority BAD)))",
    "prop set /in (qos ((dscp 64)))",
    "prop set /in (qos ((dscp NOSUCH)))",
    "prop set /in (qos ((dscp (1 2))))",
    "prop set /in (qos ((tos -1)))",
    "prop set /in (qos ((tos 256)))",
    "prop set /in (qos)",
    "prop set /in (qos ())",
    "prop set /in (sched)",
    "prop set /in (sched ((policy NOSUCH)))",
    "prop set /in (sched ((policy (1 2))))",
    "prop set /in (sched ((policy 1) (priority high)))",
    "prop set /in (sched ((policy 1) (priority (1 2))))",
    "prop set /in (sched ((policy 1) (priority 1e400)))",
    "prop set /none (qos ((tos 12)))",
    "prop set /out (process)",
    "prop set /out (process ((priority x)))",
]
REASONS = {
    "(timing ((deadline soon)))": "a deadline is a number from 0 to 86400, not 'soon'",
    "(timing ((dedline 0.1)))": '"dedline" is none of ((deadline SECONDS) (rate HZ)',
    "(timing (deadline 0.1))": "which timing takes",
    "(timing ((late never)))": 'what is late is "drop" or "keep"',
    "(monitor ((a 1)))": "no monitor here",
}


@pytest.mark.parametrize("asked", REASONS)
def test_our_own_words_are_refused_with_the_reason(asked: str, names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        out.connect("/in")
        verdict, reason = admin(names, "/out", f"prop set /in {asked}")
        assert verdict == Vocab("fail")
        assert REASONS[asked] in reason


@pytest.mark.parametrize("words", ["/in", "/in 5", "/in (x 1)", "/out", "/out (x 1)", "/none", ""])
def test_nothing_asked_for_is_granted_as_in_cpp(words: str, names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        out.connect("/in")
        assert admin(names, "/out", f"prop set {words}") == [Vocab("ok")]


@pytest.mark.parametrize("command", REFUSED)
def test_what_is_refused(command: str, names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        assert admin(names, "/out", command) == [Vocab("fail")]
        assert network.is_connected("/out", "/in", names=names)
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]


def test_dict_is_refused_as_in_cpp(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        out.connect("/in")
        reply = network.admin("/out", "prop", "set", "/in", ["qos", {"tos": 12}], names=names)
        # over text a dict becomes a list
        assert NO_MARKS or reply == [Vocab("ok")]
        with RpcClient(names=names) as client:
            client.connect("/out")
            packet = [Vocab("prop"), Vocab("set"), "/in", ["qos", {"tos": 8}]]
            from yarpy.link.ending import moment
            from yarpy.wire.message import Packet

            found = client._hub.outputs.links[0].call(Packet(packet, key="a"), moment(5))
            assert found is not None
            assert found.value == [Vocab("fail")]


def test_scheduling_of_an_output_waits_for_its_thread(names: LocalNames) -> None:
    with BufferedPort("/out", names=names) as out, Port("/in", names=names):
        out.connect("/in", "text")  # which takes time to write, so a thread does it
        assert group(admin(names, "/out", "prop get /in"), "sched") == {
            "policy": -1,
            "priority": -1,
            "tid": -1,
        }
        words = "prop set /in (sched ((policy SCHED_OTHER) (priority 0)))"
        assert admin(names, "/out", words) == [Vocab("ok")]
        assert group(admin(names, "/out", "prop get /in"), "sched")["policy"] == 0
        out.write([1])  # starts the thread
        wait_until(lambda: group(admin(names, "/out", "prop get /in"), "sched")["tid"] != -1)


@pytest.mark.skipif(not may_schedule(), reason="this process may not ask for real-time scheduling")
def test_scheduling_of_an_input_is_its_threads(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        words = "prop set /out (sched ((policy 1) (priority 5)))"
        assert admin(names, "/in", words) == [Vocab("ok")]
        thread = in_.inputs[0]._link.thread
        assert thread is not None
        assert thread.native_id is not None
        assert os.sched_getscheduler(thread.native_id) == os.SCHED_FIFO
        assert os.sched_getparam(thread.native_id).sched_priority == 5
        found = group(admin(names, "/in", "prop get /out"), "sched")
        assert found == {"policy": 1, "priority": 5, "tid": thread.native_id}
        assert admin(names, "/in", "prop set /out (sched ((priority 0) (policy 0)))") == [
            Vocab("ok")
        ]
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]


def test_user_properties(names: LocalNames) -> None:
    with Port("/it", names=names):
        assert admin(names, "/it", "prop get") == []
        assert admin(names, "/it", "prop set color (red 3)") == [Vocab("ok")]
        assert admin(names, "/it", "prop get color") == [["red", 3]]
        assert admin(names, "/it", "prop get") == [["color", ["red", 3]]]
