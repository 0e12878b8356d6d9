"""Chains: who sees a message, in which order, and what a monitor that fails costs."""

from __future__ import annotations

import logging

import pytest

from yarpy import registry
from yarpy.data.bottle import Bottle, Property
from yarpy.errors import DecodeError, LocalProtocolError, UnknownPlugin
from yarpy.monitors.base import DROP, Group, Place
from yarpy.monitors.chain import Chain, from_carrier
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message, Packet


class Word:
    """Appends a word; drops what begins with "drop"."""

    def __init__(self, word: str) -> None:
        self.word = word

    def accept(self, message: Message) -> bool:
        return bool(message.value[0] != "drop")

    def update(self, message: Message) -> object:
        return [*message.value, self.word]


def message(*values: object) -> Message:
    found = Message(DATA, Bottle(values).to_bytes(), "3 0.5")
    found.source = "/out"
    return found


def test_monitors_act_in_order() -> None:
    chain = Chain([Word("a"), Word("b")], "here")
    made = chain.take(message("hi"))
    assert made is not None
    assert made.value == ["hi", "a", "b"]
    assert (made.source, made.envelope, made.key) == ("/out", "3 0.5", DATA)
    assert chain.take(message("drop")) is None


def test_nothing_changes_unless_a_monitor_says_so() -> None:
    class Looks:
        def update(self, message: Message) -> None:
            pass

    class Same:
        def update(self, message: Message) -> Message:
            return message

    before = message("hi")
    assert Chain([Looks(), Same(), object()], "here").take(before) is before
    packet = Packet(["hi"])
    assert Chain([Looks(), Same()], "here").send(packet) is packet


def test_update_may_drop() -> None:
    class Drops:
        def update(self, message: Message) -> object:
            return DROP

    assert Chain([Drops()], "here").take(message("hi")) is None
    assert Chain([Drops()], "here").send(Packet(["hi"])) is None


@pytest.mark.parametrize(
    ("plain", "natural"),
    [(["a", ["b"]], Bottle(["a", Bottle(["b"])])), (("a", 1), Bottle(["a", 1]))],
)
def test_plain_lists_come_as_bottles(plain: object, natural: Bottle) -> None:
    class Plain:
        def update(self, message: Message) -> object:
            return plain

    made = Chain([Plain()], "here").take(message("hi"))
    assert made is not None
    assert made.value == natural
    assert type(made.value) is Bottle
    assert made.value.to_text() == natural.to_text()
    assert (made.source, made.envelope) == ("/out", "3 0.5")
    packet = Chain([Plain()], "here").send(Packet(["hi"]))
    assert packet is not None
    assert packet.value is plain  # encoded once, when it is sent


def test_what_no_message_can_hold_is_dropped(caplog: pytest.LogCaptureFixture) -> None:
    class Odd:
        def update(self, message: Message) -> object:
            return [object()]

    with caplog.at_level(logging.WARNING):
        assert Chain([Odd()], "here").take(message("hi")) is None
    assert "a monitor dropped a message" in caplog.text


def test_sent_value_is_what_the_writer_wrote() -> None:
    made = Chain([Word("a")], "here").send(Packet(("hi",), b"7", "d"))
    assert made is not None
    assert (made.value, made.envelope, made.key) == (["hi", "a"], b"7", "d")


def test_bytes_and_envelope_may_be_replaced() -> None:
    class Raw:
        def update(self, message: Message) -> Message:
            made = message.replaced(Bottle(["raw"]).to_bytes(), binary=True)
            made.envelope = "9 1.5"
            return made

    made = Chain([Raw()], "here").take(message("hi"))
    assert made is not None
    assert (made.value, made.envelope) == (["raw"], "9 1.5")
    packet = Chain([Raw()], "here").send(Packet(["hi"]))
    assert packet is not None
    assert b"".join(packet.blocks) == Bottle(["raw"]).to_bytes()
    assert (packet.line, packet.envelope) == (b"raw", b"9 1.5")


@pytest.mark.parametrize(
    "error", [ValueError("odd"), DecodeError("odd"), IndexError("odd"), SystemExit("odd")]
)
def test_monitor_that_fails_costs_the_message_and_one_line(caplog, error) -> None:
    class Fails:
        def update(self, message: Message) -> object:
            raise error

        def update_reply(self, message: Message) -> object:
            raise error

    chain = Chain([Fails()], "here")
    with caplog.at_level(logging.WARNING):
        for _ in range(3):
            assert chain.take(message("hi")) is None
        reply = message("yes")
        assert chain.reply(reply) is reply
    assert len(caplog.records) == 1
    assert "odd" in caplog.text
    assert "here" in caplog.text


def test_replies_are_updated_and_never_dropped() -> None:
    class Polite:
        def update_reply(self, message: Message) -> object:
            return [*message.value, "please"]

    class Drops:
        def update_reply(self, message: Message) -> object:
            return DROP

    assert Chain([Polite(), Drops()], "here").reply(message("yes")).value == ["yes", "please"]


def test_others_at_the_port_are_triggered_by_what_was_accepted() -> None:
    class Bell(Word):
        rung = 0

        def trigger(self) -> None:
            self.rung += 1

    group, first, second = Group(), Bell("a"), Bell("b")
    group.add(first)
    group.add(second)
    chain = Chain([first], "here", group)
    chain.take(message("hi"))
    chain.take(message("drop"))
    assert (first.rung, second.rung) == (0, 1)


def test_monitor_of_the_whole_port_triggers_nobody() -> None:
    class Bell(Word):
        rung = 0

        def trigger(self) -> None:
            self.rung += 1

    group, own, other, port_wide = Group(), Bell("a"), Bell("b"), Bell("c")
    group.add(own)
    group.add(other)
    both = Chain([own], "here", group).followed_by(Chain([port_wide], "there"))
    made = both.take(message("hi"))
    assert made is not None
    assert made.value == ["hi", "a", "c"]
    assert [bell.rung for bell in (own, other, port_wide)] == [0, 1, 0]


def test_state_of_all_that_tell() -> None:
    class Counts:
        def state(self) -> dict[str, object]:
            return {"seen": 3}

    assert Chain([Word("a"), Counts()], "here").state() == {"seen": 3}
    assert Chain([Word("a")], "here").state() == {}


def test_parameters_of_all_that_have_some() -> None:
    class Level:
        level = 1

        def configure(self, parameters: Property) -> None:
            self.level = parameters.get("level", self.level)

        def parameters(self) -> dict[str, object]:
            return {"level": self.level}

    chain = Chain([Word("a"), Level()], "here")
    assert chain.configure(Property(level=5))
    assert chain.parameters() == {"level": 5}
    assert not Chain([Word("a")], "here").configure(Property(level=5))


def test_parameters_may_be_whole_lists() -> None:
    class Colour:
        def parameters(self) -> Property:
            return Property.from_text("(colour 1 2 3)")

    assert Chain([Colour()], "here").parameters().to_text() == "(colour 1 2 3)"


def test_close_leaves_the_group_and_goes_on_after_a_failure() -> None:
    closed = []

    class Closes:
        def close(self) -> None:
            closed.append(self)
            raise ValueError("no")

    group, monitors = Group(), [Closes(), Closes()]
    for one in monitors:
        group.add(one)
    Chain(monitors, "here", group).close()
    assert closed == monitors
    assert group.members == ()


def test_made_from_a_carrier_string() -> None:
    places: list[Place] = []

    def make(place: Place) -> object:
        if place.flag("bad"):
            raise ValueError("odd")
        places.append(place)
        return object()

    def made(carrier: str) -> list[object]:
        place = Place("/out", "/in", carrier, sending=True, limit=1000)
        return from_carrier(parse_carrier(carrier), place)

    registry.monitors.add("made", make)
    try:
        made("tcp+send.made+a.1+recv.made+b.2")
        [place] = places
        assert (place.source, place.target, place.sending) == ("/out", "/in", True)
        assert place.limit == 1000
        assert (place.text("a"), place.text("b")) == ("1", "2")
        with pytest.raises(LocalProtocolError, match=r'"made" cannot start at /out -> /in.*odd'):
            made("tcp+send.made+send.made+bad")
        with pytest.raises(UnknownPlugin, match='did you mean "made"'):
            made("tcp+send.mdae")
    finally:
        registry.monitors.remove("made")


class Fails:
    def update(self, message: Message) -> object:
        raise DecodeError("what is this?")


def test_what_each_monitor_drops_is_counted() -> None:
    chain = Chain([Word("a"), Fails()], "here")
    assert (chain.dropped, chain.failures) == ([0, 0], ["", ""])
    assert chain.take(message("hi")) is None
    assert chain.send(Packet(["drop"])) is None
    assert (chain.dropped, chain.failures) == ([1, 1], ["", "what is this?"])
    both = Chain([Word("b")], "there").followed_by(chain)
    assert both.take(message("hi")) is None
    assert chain.dropped == [1, 2]
