"""Monitors between real ports: by carrier string, attached to a port, configured while running."""

from __future__ import annotations

import logging
from collections.abc import Iterator

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy import registry
from yarpy.data.bottle import Property
from yarpy.data.value import Vocab
from yarpy.monitors.base import Place
from yarpy.port.connect import probe
from yarpy.wire.message import Message


class Word:
    """Appends a word; drops what begins with "drop"."""

    def __init__(self, place: Place) -> None:
        self.word = place.text("word", "x")
        if self.word == "bad":
            raise yarpy.LocalProtocolError("bad is no word")
        living.append(self)

    def accept(self, message: Message) -> bool:
        return bool(message.value[0] != "drop")

    def update(self, message: Message) -> object:
        return [*message.value, self.word]

    def update_reply(self, message: Message) -> object:
        return [*message.value, "replied"]

    def configure(self, parameters: Property) -> None:
        self.word = parameters.get("word", self.word)

    def parameters(self) -> dict[str, object]:
        return {"word": self.word}

    def close(self) -> None:
        living.remove(self)


living: list[Word] = []


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    registry.monitors.add("word", Word)
    yield yarpy.LocalNames()
    registry.monitors.remove("word")
    wait_until(lambda: not living, what="every monitor was closed")


CARRIERS = ["tcp", "fast_tcp", "udp", "unix_stream", "local", "text_ack"]


@pytest.mark.parametrize("carrier", CARRIERS)
@pytest.mark.parametrize("kind", [yarpy.Port, yarpy.BufferedPort])
def test_both_ends_of_a_connection(names, carrier, kind) -> None:
    with kind("/in", names=names) as in_, kind("/out", names=names) as out:
        out.connect("/in", f"{carrier}+send.word+word.a+recv.word+word.b")
        for number, value in enumerate((["hi"], ["drop"], ["ho"])):
            wait_until(lambda value=value: out.write(value, "5 0.5") == (value != ["drop"]))
            if number != 1:
                message = in_.read(timeout=HANG)
                assert message.value == [*value, "a", "b"]
                assert (message.source, message.envelope) == ("/out", "5 0.5")
        wait_until(lambda: out.outputs[0].stats.messages == 2)
        stats = out.outputs[0].stats
        assert stats.drops + stats.replaced >= 1


def test_what_the_receiver_drops_is_counted_there(names) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in", "tcp+recv.word")
        for value in (["drop"], ["drop"], ["hi"]):
            assert out.write(value) == 1
        assert in_.read(timeout=HANG).value == ["hi", "x"]
        stats = in_.inputs[0].stats
        assert (stats.messages, stats.drops) == (3, 2)


def test_calls_and_their_replies(names) -> None:
    with (
        yarpy.RpcServer("/server", lambda message: message.value, names=names),
        yarpy.RpcClient(names=names) as client,
    ):
        client.connect("/server", "tcp+send.word+word.a+recv.word+word.b")
        assert client.call("hi") == ["hi", "a", "b", "replied"]
        assert client.call("drop") == []


def test_a_dropped_question_is_answered_with_nothing(names) -> None:
    with (
        yarpy.RpcServer("/server", lambda message: message.value, names=names),
        yarpy.RpcClient(names=names) as client,
    ):
        client.connect("/server", "tcp+recv.word")
        assert client.call("drop", timeout=HANG) == []
        assert client.call("hi", timeout=HANG) == ["hi", "x"]


@pytest.mark.parametrize(
    ("carrier", "kind", "text"),
    [
        ("tcp+send.wrod", yarpy.UnknownPlugin, 'did you mean "word"'),
        ("tcp+send.word+word.bad", yarpy.LocalProtocolError, "bad is no word"),
        ("tcp+recv.word+word.bad", yarpy.LocalProtocolError, "what is wrong with word there"),
        ("tcp+recv.wrod", yarpy.LocalProtocolError, "what is wrong with wrod there"),
        ("word", yarpy.UnknownPlugin, r"tcp\+recv\.word"),
    ],
)
def test_wrong_monitors_refuse_the_connection(names, caplog, carrier, kind, text) -> None:
    caplog.set_level(logging.WARNING)
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        with pytest.raises(kind, match=text):
            out.connect("/in", carrier)
        assert (out.outputs, in_.inputs) == ([], [])


def admin(port: yarpy.Port, *request: object) -> object:
    return probe.ask(port._hub.contact, [*request])


def test_parameters_while_running(names) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in", "tcp+send.word+word.a+recv.word+word.b")
        wait_until(lambda: in_.inputs)
        assert admin(in_, "get", "in", "/out") == [[["word", "b"]]]
        assert admin(out, "get", "out", "/in") == [[["word", "a"]]]
        done = admin(in_, "set", "in", "/out", ["word", "c"])
        assert done == [0, "Configured connection from /out\r\n"]
        prop = ["prop", "set", "/in", ["monitor", [["word", "d"]]]]
        assert admin(out, *prop) == [Vocab("ok")]
        out.write(["hi"])
        assert in_.read(timeout=HANG).value == ["hi", "d", "c"]


def test_attached_to_a_port(names) -> None:
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        assert admin(in_, "atch", "in", "(monitor word) (word late)") == [Vocab("ok")]
        out.connect("/in", "tcp+recv.word+word.first")
        assert admin(out, "atch", "out", ["monitor", "word"], ["word", "out"]) == [Vocab("ok")]
        assert out.write(["hi"]) == 1
        assert in_.read(timeout=HANG).value == ["hi", "out", "first", "late"]
        assert out.write(["drop"]) == 0
        assert out.outputs[0].stats.drops == 1
        assert admin(out, "get", "out", "/out") == [[["word", "out"]]]
        assert admin(out, "set", "out", "/out", ["word", "new"]) == [Vocab("ok")]
        assert admin(in_, "dtch", "in") == [Vocab("ok")]
        out.write(["ho"])
        assert in_.read(timeout=HANG).value == ["ho", "new", "first"]
        assert admin(out, "dtch", "out") == [Vocab("ok")]
        out.write(["ha"])
        assert in_.read(timeout=HANG).value == ["ha", "first"]


def test_monitor_of_a_port_is_told_one_name(names) -> None:
    """As in C++: the other end is whoever is connected."""
    places: list[Place] = []
    registry.monitors.add("told", lambda place: places.append(place) or object())
    try:
        with yarpy.Port("/in", names=names) as in_:
            for side in ("in", "out"):
                assert admin(in_, "atch", side, "(monitor told)") == [Vocab("ok")]
    finally:
        registry.monitors.remove("told")
    assert [(p.source, p.target, p.carrier, p.sending) for p in places] == [
        ("", "/in", "", False),
        ("/in", "", "", True),
    ]
    assert [str(place) for place in places] == ["input of /in", "output of /in"]


def test_attaching_what_does_not_start_says_why(names) -> None:
    with yarpy.Port("/in", names=names) as in_:
        for parameters, text in (
            ("(monitor nosuch)", "nosuch"),
            ("(monitor word) (word bad)", "bad"),
        ):
            reply = admin(in_, "atch", "in", parameters)
            assert reply[0] == Vocab("fail")
            assert reply[1].startswith("Failed to configure the portmonitor plug-in")
            assert text in reply[1]


def test_monitors_are_told_the_limit_of_their_port_and_who_finds_others(
    names: yarpy.LocalNames,
) -> None:
    places: list[Place] = []

    def make(place: Place) -> object:
        places.append(place)
        return object()

    registry.monitors.add("told", make)
    try:
        with (
            yarpy.Port("/out", names=names) as out,
            yarpy.Port("/in", names=names, limit=5000),
        ):
            out.connect("/in", "tcp+send.told+recv.told")
            wait_until(lambda: len(places) == 2, what="both monitors are there")
    finally:
        registry.monitors.remove("told")
    places.sort(key=lambda place: place.sending)
    assert [place.limit for place in places] == [5000, 1 << 30]
    assert all(place.names is names for place in places)
