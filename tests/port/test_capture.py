"""The recorded dialogues, said again to real ports over real sockets.

Rules: whole and one byte at a time. Whatever the port of a capture was connected to is set up with
`LocalNames`; every byte must be that of C++ 3.9.1 unless support/difference.py says otherwise.
At the end the client closes its side: nothing more may come.
"""

from __future__ import annotations

import re

import pytest
from support.capture import Capture, groups, load_capture
from support.difference import NOT_REPLAYED
from support.guest import guest
from support.live import World, hear, nothing_more, replay, say
from support.system import NO_MARKS, NO_POLICIES, NO_SCHEDULING
from support.wait import HANG, wait_until

from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.port.port import Port

PIECES = [0, 1]

# Who was asked, where the capture does not say it by name.
ASKED = {
    "admin_add_rpc_first": "/cap/rc2",
    "admin_add_rpc_again": "/cap/rc2",
    "admin_add_rpc_other_target": "/cap/rc2",
    "admin_add_rpc_server_as_source": "/cap/srv",
    "api_adm_1": "/cap/in",
    "api_exists_2": "/cap/in",
    "api_isconn_1": "/cap/out",
    "api_isconn_carrier_1": "/cap/out",
    "api_style_tcp_1": "/cap/srv",
}
LINKED = {
    *("admin_add_del", "admin_binary", "admin_get_set", "admin_list_input_port"),
    *("admin_prop_qos", "admin_prop_sched", "api_getqos_1_out", "api_isconn_1"),
    *("api_isconn_carrier_1", "api_qos_1_out", "api_qos_2_in", "disconnect_admin_1"),
    *("disconnect_admin_2", "receiver_close_admin_1", "receiver_close_admin_2"),
}
SPECIAL = {
    "telnet_reader",
    "telnet_rooted_sender_dup",
    "telnet_env_reader",
    "telnet_drop_self_after",
    "telnet_ns",  # tests/nameserver/test_serving.py
}
REPLAYED = sorted(
    {
        *groups()["administration"],
        *groups()["telnet"],
        *groups()["malformed"],
        *(n for n in groups()["connections"] if "rpc" in n and "name_ser" not in n),
    }
    - SPECIAL
    - NOT_REPLAYED.keys()
)


def asked(capture: Capture) -> str:
    found = re.search(r"/cap/\w+", capture.roles["b"])
    return ASKED.get(capture.name) or (found[0] if found else "")


def prepare(world: World, name: str) -> None:
    """What had happened before the capture began."""
    for other in ("/cap/in", "/cap/in2", "/cap/srv2"):
        if name.startswith(("admin_add", "admin_binary", "telnet_connect")):
            world.port(other)
    if name in LINKED:
        world.connect("/cap/out", "/cap/in")
    if name in ("admin_add_rpc_again", "admin_add_rpc_other_target"):
        world.connect("/cap/rc2", "/cap/srv2")
    if name == "admin_prop_qos":
        world.admin("/cap/out", "prop set /cap/in (sched ((policy 0) (priority 0)))")
    if name == "api_getqos_1_out":
        # Each by itself: the system may refuse the first.
        world.admin("/cap/out", "prop set /cap/in (sched ((policy 1) (priority 30)))")
        world.admin("/cap/out", "prop set /cap/in (qos ((tos 144)))")


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", REPLAYED)
def test_dialogue(name: str, piece: int, monkeypatch: pytest.MonkeyPatch) -> None:
    if name.startswith("admin_ros_"):
        guest("ros")
    lacking = NO_POLICIES if "sched" in name else ""
    if "qos" in name:
        lacking = NO_MARKS or NO_SCHEDULING
    if lacking:
        pytest.skip(lacking)
    monkeypatch.setenv("YARPY_SCRIPTS", "network")  # C++ lets anybody attach one
    capture = load_capture(name)
    with World() as world:
        prepare(world, name)
        with world.dial(asked(capture)) as sock:
            replay(sock, capture, piece)
            nothing_more(sock)


# ---------------------------------------------------------------------------------- special ones


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
def test_port_goes_on_after_a_connection_ended_itself(piece: int) -> None:
    """`~test` said by test: C++ deadlocks, and its next client hears nothing."""
    with World() as world:
        with world.dial("/cap/self") as sock:
            replay(sock, load_capture("telnet_drop_self"), piece)
            nothing_more(sock)
        wait_until(lambda: not world.port("/cap/self").inputs)
        with world.dial("/cap/self") as sock:
            replay(sock, load_capture("telnet_drop_self_after"), piece)
            nothing_more(sock)


def test_second_client_of_a_rooted_name_displaces_the_first() -> None:
    capture = load_capture("telnet_rooted_sender_dup")
    with World() as world, world.dial("/cap/in") as first:
        say(first, capture.steps[0].data, 0)
        assert hear(first, len(capture.steps[1].data)) == capture.steps[1].data
        say(first, b"d\r\n1\r\n", 0)
        wait_until(lambda: len(world.heard) == 1)
        with world.dial("/cap/in") as second:
            say(second, capture.steps[0].data, 0)
            assert hear(second, len(capture.steps[1].data)) == capture.steps[1].data
            assert first.recv(100) == b""
            say(second, b"d\r\n2\r\n", 0)
            wait_until(lambda: len(world.heard) == 2)
        assert [m.value for m in world.heard] == [[1], [2]]


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
def test_envelopes_that_a_person_types(piece: int) -> None:
    capture = load_capture("telnet_env_reader")
    with World() as world, world.dial("/cap/in") as sock:
        replay(sock, capture, piece)
        nothing_more(sock)
        # The console of the C++ reader; there "do 9 3.5" kept its blank: [ 9 3.5].
        assert [(m.envelope, m.value) for m in world.heard] == [
            ("", [1]),
            ("7 1.5", [2]),
            ("8 2.5", [3]),
            ("9 3.5", [4]),
            ("10 4.5", [5]),
        ]


def test_envelope_belongs_to_its_message() -> None:
    """In C++ it sticks to later messages without one, and leaks into what the port writes."""
    with World() as world, world.dial("/cap/in") as sock:
        say(sock, b"CONNECT test\r\nD 8 2.5\r\n1\r\nD\r\n2\r\n", 0)
        wait_until(lambda: len(world.heard) == 2)
        assert [m.envelope for m in world.heard] == ["8 2.5", ""]


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
def test_person_becomes_a_reader(piece: int) -> None:
    """`r`, then what the port writes; a `q` said afterwards is not noticed."""
    capture = load_capture("telnet_reader")
    with World() as world:
        port = world.port("/cap/out")
        assert isinstance(port, Port)
        with world.dial("/cap/out") as sock:
            say(sock, capture.steps[0].data, piece)
            assert hear(sock, len(capture.steps[1].data)) == capture.steps[1].data
            say(sock, capture.steps[2].data, piece)
            assert port.wait_for_outputs(timeout=HANG)
            assert port.outputs[0].target == "telnet"
            assert port.write([1, "ping", 3.14]) == 1
            port.write([b"\1\2\3", "two words", Vocab("set"), ["x"]], Stamp(5, 2.5))
            assert hear(sock, len(capture.steps[3].data)) == capture.steps[3].data
            say(sock, capture.steps[4].data, piece)
            port.write([3], Stamp(5, 2.5))
            assert hear(sock, len(capture.steps[5].data)) == capture.steps[5].data
        # The person hung up: the port notices, at the latest while writing.
        wait_until(lambda: port.write([4]) == 0 and not port.outputs)


REVERSED = [n for n in groups()["connections"] if n.startswith("reverse_")]


@pytest.mark.parametrize("piece", PIECES, ids=["whole", "bytewise"])
@pytest.mark.parametrize("name", REVERSED)
def test_reader_that_dials(name: str, piece: int) -> None:
    """The port's own writing, byte for byte what C++ wrote, acknowledged by the captured bytes."""
    capture = load_capture(name)
    stamps = [Stamp(1, 0.25), Stamp(2, 1.25), Stamp(3, 2.25), Stamp(3, 2.25)]
    nested = [["a", [1, 2]], [1.5, "x y"], Vocab("set")]
    values = [[], [1, "ping", 3.14], nested, [9]]
    acks = [s.data for s in capture.steps[3:] if s.sender == "a"]
    with World() as world:
        port = world.port("/cap/out")
        assert isinstance(port, Port)
        with world.dial("/cap/out") as sock:
            say(sock, capture.steps[0].data, piece)
            greeting = capture.steps[1]
            got = hear(sock, len(greeting.data))
            assert capture.masked(greeting, got) == capture.masked(greeting, greeting.data)
            say(sock, capture.steps[2].data, piece)
            assert port.wait_for_outputs(timeout=HANG)
            wanted = b"".join(s.data for s in capture.steps[3:] if s.sender == "b")
            got = b""
            for number, value in enumerate(values):
                port.write(value, stamps[number] if "envelope" in name else None)
                if acks and number < len(acks):
                    say(sock, acks[number], piece)
            assert hear(sock, len(wanted)) == wanted
