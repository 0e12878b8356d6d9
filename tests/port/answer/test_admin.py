"""The administrative channel: corners. Its dialogues with C++ tools are in test_capture."""

from __future__ import annotations

import struct

import pytest
from support.wait import HANG, wait_until

from yarpy import network
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.limit import PROPERTIES
from yarpy.link.ending import moment
from yarpy.nameserver.local import LocalNames
from yarpy.port.answer import admin
from yarpy.port.port import Port
from yarpy.wire.message import ADMIN, Message, Packet

WORDS = [
    ("list", "list"),
    (Vocab("list"), "list"),
    ("listing", "list"),  # the first four characters count
    ("ver", "ver"),
    (5, ""),
    (["list"], ""),
    (b"list", ""),
]


@pytest.mark.parametrize(("value", "word"), WORDS)
def test_command_words(value: object, word: str) -> None:
    assert admin.word(value) == word


ASKED = [
    # command, answer
    ("[ver]", "[ver] 1 2 3"),
    ("ver", "[ver] 1 2 3"),
    ("version please", '[fail] "send [help] for list of valid commands"'),
    ("[list]", ""),
    ("[list] [out]", ""),
    ("[list] [foo]", ""),
    ("[list] [out] /none", ""),
    ("[dtch] [out]", "[ok]"),
    ("[prop] [get] none", ""),
    ("[prop] [get] /none", '[fail] "cannot find any connection to/from /none"'),
    ("", '[fail] "send [help] for list of valid commands"'),
    ("()", '[fail] "send [help] for list of valid commands"'),
    ("5", '[fail] "send [help] for list of valid commands"'),
    ("{1 2}", '[fail] "send [help] for list of valid commands"'),
]


@pytest.mark.parametrize(("command", "answer"), ASKED)
def test_answers(command: str, answer: str, names: LocalNames) -> None:
    with Port("/it", names=names) as port:
        message = Message(ADMIN, command.encode(), spelling="text")
        assert admin.answer(port._hub, message).to_text() == answer
        binary = Message(ADMIN, Bottle.from_text(command).to_bytes())
        assert admin.answer(port._hub, binary).to_text() == answer


def test_help_names_every_command(names: LocalNames) -> None:
    with Port("/it", names=names):
        lines = network.admin("/it", "help", names=names)
    assert lines[0] == Vocab("many")
    for word in ("help", "ver", "add", "del", "list", "prop", "atch", "dtch"):
        assert any(str(line).startswith(f"[{word}]") for line in lines), word


def test_message_that_is_no_bottle_is_refused(names: LocalNames) -> None:
    from yarpy.port.rpc import RpcClient

    class Broken:
        def to_wire(self) -> tuple[bytes]:
            return (struct.pack("<3i", 999, 1, 5),)

    with Port("/it", names=names), RpcClient(names=names) as client:
        client.connect("/it")
        link = client._hub.outputs.links[0]
        reply = link.call(Packet(Broken(), key=ADMIN), moment(5))
        assert reply is not None
        assert reply.value[0] == Vocab("fail")
        assert isinstance(reply.value[1], str)
        reply = link.call(Packet([Vocab("ver")], key=ADMIN), moment(5))
        assert reply is not None
        assert reply.value == [Vocab("ver"), 1, 2, 3]


def test_connection_can_be_deleted_from_either_end(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        reply = network.admin("/in", Vocab("del"), "/out", names=names)
        assert reply == [0, "Removing connection from /out to /in\r\n"]


def test_replies_have_lists_of_names_and_details(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        out.connect("/in", "udp")
        assert in_.wait_for_inputs(timeout=HANG)
        assert network.admin("/out", "list", "out", names=names) == ["/in"]
        # Who asked before may still be there.
        wait_until(lambda: network.admin("/in", "list", "in", names=names) == ["/out", "admin"])
        assert network.admin("/in", "list", "in", "/out", names=names) == [
            ["from", "/out"],
            ["to", "/in"],
            ["carrier", "udp"],
            ["connectionless", 1],
        ]


def test_own_name_is_prayed_to(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARP_ROBOT_NAME", raising=False)
    with Port("/robot/arm", names=names):
        lines = network.admin("/robot/arm", "pray", names=names)
        assert lines[:2] == ["You begin praying to robot.", "You finish your prayer."]
        monkeypatch.setenv("YARP_ROBOT_NAME", "icub")
        assert network.admin("/robot/arm", "pray", names=names)[0] == "You begin praying to icub."


def test_strangers_cannot_store_without_end(names: LocalNames) -> None:
    with Port("/p", names=names) as port:

        def prop(*words: object) -> Bottle:
            message = Message("a", Bottle(["prop", *words]).to_bytes())
            return admin.answer(port._hub, message)

        assert prop("set", "big", "x" * (PROPERTIES - 1000)) == [Vocab("ok")]
        refusal = [Vocab("fail"), "the properties of a port take at most 1048576 bytes"]
        assert prop("set", "more", bytes(2000)) == refusal
        assert prop("set", "y" * 2000) == refusal
        assert prop("get", "more") == []
        assert prop("set", "small", 5) == [Vocab("ok")]
        assert prop("set", "big", "less") == [Vocab("ok")]  # it takes the place of the other
        assert prop("set", "more", bytes(2000)) == [Vocab("ok")]
        assert prop("get", "small") == [5]
