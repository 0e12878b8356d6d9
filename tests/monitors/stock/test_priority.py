"""priority: its parameters, and several senders that compete for one port."""

from __future__ import annotations

import itertools
import logging
import threading
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.wait import HANG, wait_until

import yarpy
from yarpy import network
from yarpy.data.bottle import Bottle, Property
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.monitors.base import Group, Place
from yarpy.monitors.stock.priority import Priority
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message

MESSAGE = Message(DATA, Bottle([1]).to_bytes())


class Contest:
    """Connections into one port, and its clock."""

    def __init__(self) -> None:
        self.now = 100.0
        self.group = Group()

    def join(self, source: str, tokens: str = "") -> Priority:
        parts = parse_carrier(f"tcp+recv.priority{tokens}").tokens
        place = Place(source, "/in", "tcp", False, parts, parts, self.group)
        one = Priority(place, clock=lambda: self.now)
        self.group.add(one)
        return one

    def at(self, when: float, one: Priority) -> bool:
        self.now = 100.0 + when
        return one.accept(MESSAGE)


@pytest.fixture
def contest() -> Contest:
    return Contest()


def test_defaults(contest: Contest) -> None:
    text = Property(contest.join("/a").parameters()).to_text()
    assert text == '(bs 1.0) (ex "") (st 1.0) (tc 1.0) (tr 0.0) (virtual 0)'


@pytest.mark.parametrize(
    ("tokens", "key", "value"),
    [
        ("+st.5", "st", 0.5),
        ("+st.-5", "st", 0.5),
        ("+st.0", "st", 1.0),
        ("+bs.20", "bs", 2.0),
        ("+bs.-20", "bs", -2.0),
        ("+tc.-2", "tc", 2.0),
        ("+tr.1", "tr", 1.0),
        ("+virtual", "virtual", 1),
        ("+virtual.1", "virtual", 1),
        ("+virtual.0", "virtual", 0),
        ("+(ex (/b -10) (/c 2.5))", "ex", 'ex ("/b" -10) ("/c" 2.5)'),
        ("+((ex (/b -10)))", "ex", 'ex ("/b" -10)'),
        ("+ex.(/b,-10)(/c,5)", "ex", 'ex ("/b" -10) ("/c" 5)'),
        ("+ex.(/b,-10)", "ex", 'ex ("/b" -10)'),
        ("+ex", "ex", ""),
        ("+tc.1+tc.3", "tc", 3.0),
    ],
)
def test_parameters_of_a_carrier_string(
    contest: Contest, tokens: str, key: str, value: object
) -> None:
    assert contest.join("/a", tokens).parameters()[key] == value


def test_weights_are_tenths(contest: Contest) -> None:
    one = contest.join("/a", "+(ex (/b -10) (/c 2.5))")
    assert one.competitor.weights == (("/b", -1.0), ("/c", 0.25))
    one.configure(Property.from_text("(ex (/d 5))"))
    assert one.competitor.weights == (("/d", 0.5),)
    assert one.parameters()["ex"] == 'ex ("/d" 5)'
    for nothing in ("(ex)", '(ex "")'):
        one.configure(Property.from_text("(ex (/d 5))"))
        one.configure(Property.from_text(nothing))
        assert one.competitor.weights == ()


@pytest.mark.parametrize("tokens", ["+st.many", "+bs", "+tc.nan", "+tr.inf", "+bs.1e99",
                                    "+(ex (/a much))", "+(ex (/a))", "+(ex (/a nan))", "+ex./a,-10",
                                    "+ex./5"])  # fmt: skip
def test_wrong_parameters_refuse(contest: Contest, tokens: str) -> None:
    with pytest.raises(LocalProtocolError, match=r"takes (a number|links)"):
        contest.join("/a", tokens)


def test_it_decides_at_the_receiving_end_only() -> None:
    with pytest.raises(LocalProtocolError, match=r"\+recv\.priority"):
        Priority(Place("/a", "/b", sending=True))


def test_settings_while_running_are_not_scaled(contest: Contest) -> None:
    one = contest.join("/a")
    one.configure(Property.from_text("(bs 0.25) (st 0.5) (tc 2) (tr 1) (virtual 1) (other 7)"))
    text = Property(one.parameters()).to_text()
    assert text == '(bs 0.25) (ex "") (st 0.5) (tc 2.0) (tr 1.0) (virtual 1)'


@pytest.mark.parametrize(
    "text", ["(tc x)", "(bs ())", "(bs nan)", "(st inf)", "(ex (/a x))", "(ex /a -10)"]
)
def test_wrong_settings_change_nothing(contest: Contest, text: str) -> None:
    one = contest.join("/a")
    before = one.parameters()
    with pytest.raises(LocalProtocolError, match="takes"):
        one.configure(Property.from_text(f"(tr 5) {text}"))
    assert one.parameters() == before


def test_recorded_contest(contest: Contest) -> None:
    a, b = contest.join("/pa"), contest.join("/pb", "+bs.5")
    assert contest.at(0.0, b)
    assert [contest.at(0.5, a), contest.at(0.6, b), contest.at(0.7, a)] == [True, False, True]
    assert contest.at(2.0, b)
    a.configure(Property.from_text("(bs 0.2)"))
    assert [contest.at(2.1, a), contest.at(2.2, b)] == [False, True]
    v = contest.join("/pv", "+tc.2+virtual+(ex (/pb -10) (/pa 10))")
    assert [contest.at(2.3, v), contest.at(2.4, a), contest.at(2.5, b)] == [False, True, False]
    assert a.state() == {
        "active": True,
        "output": pytest.approx(1.2),
        "stimulation": pytest.approx(a.competitor.stimulation(contest.now)),
        "winner": "/pa",
    }
    assert v.state()["winner"] == "/pa"
    contest.now += 10
    assert a.state() == {"active": False, "output": 0, "stimulation": 0, "winner": ""}


def test_virtual_connection_alone_lets_nothing_through(contest: Contest) -> None:
    assert not contest.at(0.0, contest.join("/v", "+virtual"))


def test_others_at_the_port_take_no_part(contest: Contest) -> None:
    contest.group.add(object())
    assert contest.at(0.0, contest.join("/a"))


def test_who_has_left_holds_nobody_back(contest: Contest) -> None:
    a, b = contest.join("/a", "+bs.20"), contest.join("/b")
    assert contest.at(0.0, a)
    assert not contest.at(0.1, b)
    contest.group.remove(a)
    assert contest.at(0.2, b)


def test_monitor_of_a_whole_port_is_alone() -> None:
    assert Priority(Place("/in", "/in")).accept(MESSAGE)


def test_contradicting_weights_drop_with_one_line(
    contest: Contest, caplog: pytest.LogCaptureFixture
) -> None:
    a = contest.join("/a", "+(ex (/b 10))")
    b = contest.join("/b", "+(ex (/a 10))")
    assert contest.at(0.0, a)
    with caplog.at_level(logging.WARNING):
        assert not any(contest.at(0.1 + n / 100, b) for n in range(5))
    assert len(caplog.records) == 1
    assert "/b -> /in" in caplog.text
    assert b.state()["winner"] == ""


@given(st.text(max_size=40))
def test_any_token_makes_a_monitor_or_a_clear_error(text: str) -> None:
    for token in (text, f"ex.{text}", f"(ex {text})", f"st.{text}", f"bs.{text}"):
        place = Place("/a", "/in", "tcp", False, (token,))
        try:
            Priority(place).accept(MESSAGE)
        except YarpError:
            pass


@given(st.text(max_size=60))
def test_any_setting_is_taken_or_refused(text: str) -> None:
    one = Contest().join("/a")
    for settings in (Property.from_text(text), Property.from_text(f"(ex {text}) (bs {text})")):
        try:
            one.configure(settings)
        except YarpError:
            pass
        one.accept(MESSAGE)


# -- ports ----------------------------------------------------------------------------------------


class Senders:
    """Threads that write their port's name all the time."""

    def __init__(self, names: yarpy.LocalNames) -> None:
        self.names = names
        self.ports: list[yarpy.Port] = []
        self._stop = threading.Event()
        self._threads: list[threading.Thread] = []

    def add(self, name: str, carrier: str) -> yarpy.Port:
        port = yarpy.Port(name, names=self.names)
        self.ports.append(port)
        port.connect("/in", carrier)
        thread = threading.Thread(target=self._run, args=(port,), daemon=True)
        self._threads.append(thread)
        thread.start()
        return port

    def _run(self, port: yarpy.Port) -> None:
        for number in itertools.count():
            if self._stop.wait(0.005):
                return
            port.write([port.name, number])

    def close(self) -> None:
        self._stop.set()
        for thread in self._threads:
            thread.join(HANG)
        for port in self.ports:
            port.close()


@pytest.fixture
def senders() -> Iterator[Senders]:
    found = Senders(yarpy.LocalNames())
    yield found
    found.close()


def only(port: yarpy.BufferedPort, name: str) -> None:
    """Wait until one sender has the port for itself."""
    last = [""] * 20

    def settled() -> bool:
        for _ in range(5):
            last.append(port.read(timeout=HANG).value[0])
        return set(last[-20:]) == {name}

    wait_until(settled, timeout=HANG, what=f"only {name} gets through")


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "udp", "unix_stream", "local", "text_ack"])
def test_one_of_three_gets_through(senders: Senders, carrier: str) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=senders.names) as port:
        senders.add("/weak", f"{carrier}+recv.priority+tc.2+bs.2")
        only(port, "/weak")
        senders.add("/strong", f"{carrier}+recv.priority+tc.2+bs.10")
        senders.add("/middle", f"{carrier}+recv.priority+tc.2+bs.5")
        only(port, "/strong")
        wait_until(
            lambda: all(link.stats.drops for link in port.inputs if link.source != "/strong")
        )
        reply = network.admin("/in", "set", "in", "/weak", ["bs", 3.0], names=senders.names)
        assert reply == [0, "Configured connection from /weak\r\n"]
        only(port, "/weak")
        reply = network.admin("/in", "get", "in", "/weak", names=senders.names)
        assert Bottle(reply[0]).find("bs") == 3.0
        told = network.admin("/in", "prop", "get", "/weak", names=senders.names)
        state = Property.from_bottle(told.find("state"))
        assert (state["active"], state["winner"], state["output"]) == (1, "/weak", 3.0)


def test_virtual_connection_switches_the_others(senders: Senders) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=senders.names) as port:
        senders.add("/ball", "tcp+recv.priority+tc.2+bs.0")
        senders.add("/line", "tcp+recv.priority+tc.2+bs.10")
        only(port, "/line")
        choice = "(ex (/line -10) (/ball 10))"
        selector = senders.add("/selector", f"tcp+recv.priority+tc.2+virtual+{choice}")
        only(port, "/ball")
        selector.disconnect("/in")
        only(port, "/line")


def test_wrong_parameter_refuses_the_connection(
    senders: Senders, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.WARNING)
    with (
        yarpy.Port("/in", names=senders.names),
        yarpy.Port("/out", names=senders.names) as out,
        pytest.raises(yarpy.LocalProtocolError, match="what is wrong with priority"),
    ):
        out.connect("/in", "tcp+recv.priority+st.much")
    wait_until(lambda: '"st" takes a number' in caplog.text)  # by another thread
