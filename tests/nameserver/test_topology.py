"""Persistent connections and topics: which events make or break which connections."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import AddressError
from yarpy.nameserver import topology as module
from yarpy.nameserver.topology import (
    Action,
    Subscription,
    Topology,
    bare_name,
    split_network,
    undecorate,
)


class Clock:
    now = 1000.0

    def __call__(self) -> float:
        return self.now


def everybody(name: str) -> bool:
    return True


def connect(source: str, destination: str, carrier: str = "") -> Action:
    return Action("connect", source, destination, carrier, source)


@pytest.fixture
def topology() -> Topology:
    return Topology(Clock())


def test_both_ends_must_be_live(topology: Topology) -> None:
    assert topology.subscribe("/a", "/b", "", everybody) == []
    assert topology.announce("/a") == []
    assert topology.announce("/b") == [connect("/a", "/b")]
    assert topology.announce("/b") == [connect("/a", "/b")], "a port that says so twice, twice"


def test_a_rule_added_late_connects_at_once(topology: Topology) -> None:
    topology.announce("/a")
    topology.announce("/b")
    assert topology.subscribe("/a", "udp://b", "", everybody) == [connect("/a", "/b", "udp")]


def test_the_carrier_is_the_destinations(topology: Topology) -> None:
    topology.announce("/a")
    topology.announce("/b")
    assert topology.subscribe("udp://a", "/b", "", everybody) == [connect("/a", "/b")]
    modified = "fast_tcp+recv.priority://b"
    assert topology.subscribe("/a", modified, "", everybody) == [
        connect("/a", "/b", "fast_tcp+recv.priority")
    ]
    assert len(topology.subscriptions()) == 1, "one rule for a pair of names"


def test_unregistering_breaks_and_asks_who_is_left(topology: Topology) -> None:
    topology.subscribe("/a", "/b", "", everybody)
    topology.announce("/a")
    topology.announce("/b")
    (action,) = topology.vanish("/a")
    assert action == Action("disconnect", "/a", "/b", "", "/b")
    assert action.peer == "/a"
    assert topology.vanish("/a") == [action], "whether it was live or not, nobody may wait for it"
    topology.announce("/a")
    assert topology.vanish("/b")[0].ask == "/a"
    assert topology.vanish("/a") == [], "nobody is left to be asked"
    assert len(topology.subscriptions()) == 1


def test_through_a_topic(topology: Topology) -> None:
    for name in ("/w1", "/w2", "/r1", "/r2", "/r3"):
        topology.announce(name)
    assert topology.subscribe("/w1", "topic://t", "", everybody) == []
    assert topology.subscribe("topic://t", "/r1", "", everybody) == [connect("/w1", "/r1")]
    assert topology.subscribe("topic://t", "udp://r2", "", everybody) == [
        connect("/w1", "/r2", "udp")
    ]
    assert topology.subscribe("/w2", "topic://t", "", everybody) == [
        connect("/w2", "/r1"),
        connect("/w2", "/r2", "udp"),
    ]
    assert topology.topics == {"/t": ""}
    topology.vanish("/w1")
    assert topology.announce("/w1") == [connect("/w1", "/r1"), connect("/w1", "/r2", "udp")]
    assert [a.ask for a in topology.vanish("/r1")] == ["/w1", "/w2"]


def test_without_the_topic_the_rules_stay_and_do_nothing(topology: Topology) -> None:
    topology.subscribe("/w", "topic://t", "", everybody)
    topology.subscribe("topic://t", "/r", "", everybody)
    topology.undeclare("/t")
    topology.undeclare("/t")
    topology.announce("/w")
    assert topology.announce("/r") == []
    assert len(topology.subscriptions()) == 2
    assert topology.declare("/t", "(x 1)") == [connect("/w", "/r")]
    assert topology.declare("/t") == []


def test_rules_tied_to_a_life(topology: Topology) -> None:
    topology.subscribe("/a", "/b", "from", everybody)
    topology.subscribe("/c", "/a", "from", everybody)
    topology.subscribe("/d", "/a", "to", everybody)
    topology.subscribe("/a", "/e", "to", everybody)
    topology.vanish("/a")
    left = {(rule.source, rule.destination) for rule in topology.subscriptions()}
    assert left == {("/c", "/a"), ("/a", "/e")}


@pytest.mark.parametrize(("mode", "missing"), [("from", "/a"), ("to", "/b")])
def test_a_life_that_has_not_begun_stores_nothing(
    topology: Topology, mode: str, missing: str
) -> None:
    topology.announce("/a")
    topology.announce("/b")
    assert topology.subscribe("/a", "/b", mode, lambda name: name != missing) == []
    assert topology.subscriptions() == []
    assert topology.subscribe("/a", "/b", mode, lambda name: name == missing) != []
    topology.subscribe("/a", "/b", mode, lambda name: name != missing)
    assert topology.subscriptions() == [], "it replaced the other rule before it was dropped"


def test_a_topic_need_not_be_registered(topology: Topology) -> None:
    topology.subscribe("/a", "topic://t", "to", lambda name: False)
    assert len(topology.subscriptions("/t")) == 1
    topology.subscribe("/b", "/t", "to", lambda name: False)
    assert len(topology.subscriptions("/t")) == 1, "it must be called a topic to count as one"


def test_unsubscribe_leaves_the_connection(topology: Topology) -> None:
    topology.subscribe("/a", "udp://b", "", everybody)
    topology.announce("/a")
    assert topology.unsubscribe("tcp://a", "/b")
    assert not topology.unsubscribe("/a", "/b")
    assert topology.announce("/b") == []


def test_a_complaint_counts_after_half_a_minute(topology: Topology) -> None:
    clock = topology.clock
    assert isinstance(clock, Clock)
    topology.announce("/a")
    topology.complain("/a")
    assert "/a" in topology.live
    clock.now += 30.5
    topology.complain("/a")
    assert "/a" not in topology.live
    topology.complain("/nobody")


def test_subscriptions_by_name_and_in_order(topology: Topology) -> None:
    for source, destination in (("/b", "topic://t"), ("udp://a", "/z"), ("/a", "/b")):
        topology.subscribe(source, destination, "", everybody)
    assert [rule.source_text for rule in topology.subscriptions()] == ["/a", "udp://a", "/b"]
    assert [rule.destination for rule in topology.subscriptions("/b")] == ["/b", "/t"]
    assert topology.subscriptions("/t") == [Subscription("/b", "topic://t")]
    assert topology.subscriptions("/nope") == []


def test_collecting_forgets_the_unregistered(topology: Topology) -> None:
    topology.announce("/a")
    topology.announce("/b")
    topology.collect(lambda name: name == "/b")
    assert list(topology.live) == ["/b"]


def test_refusals() -> None:
    topology = Topology(Clock(), limit=2)
    for source, destination, mode in (
        ("", "/b", ""),
        ("/a", "tcp:/", ""),
        ("/a", "/b", "both"),
        ("/a\0", "/b", ""),
        ("/a", "/" + "b" * 1000, ""),
    ):
        with pytest.raises(AddressError):
            topology.subscribe(source, destination, mode, everybody)
    for name, structure in (("/" + "x" * 1000, ""), ("/x", "s" * 70_000), ("/\0", "")):
        with pytest.raises(AddressError):
            topology.declare(name, structure)
        with pytest.raises(AddressError):
            topology.describe(name, structure)
    with pytest.raises(AddressError):
        topology.announce("x" * 1001)
    for name in ("/a", "/b"):
        topology.announce(name)
        topology.declare(name)
        topology.describe(name, "x")
        topology.subscribe(name, "/r", "", everybody)
    with pytest.raises(AddressError, match="at most 2"):
        topology.announce("/c")
    with pytest.raises(AddressError, match="at most 2"):
        topology.declare("/c")
    with pytest.raises(AddressError, match="at most 2"):
        topology.describe("/c", "x")
    with pytest.raises(AddressError, match="at most 2"):
        topology.subscribe("/c", "/r", "", everybody)


def test_undecorate() -> None:
    assert undecorate("/cam") == ("", "/cam")
    assert undecorate("mcast://pr3") == ("mcast", "/pr3")
    assert undecorate("/udp://x") == ("udp", "/x")
    assert undecorate("tcp:/x") == ("tcp", "x")
    assert undecorate("") == ("", "")


def test_networks() -> None:
    assert split_network("/net=127.0.0/a/b") == ("127.0.0", "/a/b")
    assert split_network("/NET=127") == ("127", "")
    assert split_network("/network/x") == (None, "/network/x")
    assert bare_name("udp://net=10/x") == "/x"


def test_a_network_does_not_make_another_rule(topology: Topology) -> None:
    topology.subscribe("/net=10/a", "/b", "", everybody)
    assert [rule.source_text for rule in topology.subscriptions("/a")] == ["/net=10/a"]
    assert topology.unsubscribe("/a", "/b")


def test_restore_works_like_the_events(topology: Topology) -> None:
    rules = [Subscription("/a", "topic://t"), Subscription("topic://t", "udp://b")]
    topology.restore(rules, {"/t": ""}, {"/a": 990.0}, {"x": "y"})
    assert topology.announce("/b") == [connect("/a", "/b", "udp")]


NAMES = st.sampled_from(["/a", "/b", "/t", "topic://t", "udp://a", "topic://u", "/u"])
EVENTS = st.one_of(
    st.tuples(st.sampled_from(["announce", "vanish", "complain", "declare", "undeclare"]), NAMES),
    st.tuples(st.sampled_from(["subscribe", "unsubscribe"]), NAMES, NAMES),
)


@given(st.lists(EVENTS, max_size=30))
def test_any_events(events: list[tuple[str, ...]]) -> None:
    """Only live ports are connected, only live ones are asked, and the indexes stay sound."""
    topology = Topology(Clock())
    for verb, *names in events:
        if verb == "subscribe":
            actions = topology.subscribe(*names, "", everybody)
        else:
            actions = getattr(topology, verb)(*names)
        for action in actions if isinstance(actions, list) else ():
            assert action.ask in topology.live
            assert action.kind == "disconnect" or {action.source, action.destination} <= set(
                topology.live
            )
    for rule in topology.subscriptions():
        topology.unsubscribe(rule.source_text, rule.destination_text)
    assert not topology._rules and not topology._out and not topology._in


def test_descriptions_have_a_limit_together(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "TOTAL_STRUCTURES", 100)
    topology = Topology(Clock())
    topology.restore([], {"/old": "x" * 40}, {}, {"t": "x" * 20})
    topology.describe("u", "x" * 40)
    for _ in range(2):
        with pytest.raises(AddressError, match="at most 100 characters of descriptions"):
            topology.declare("/new", "x")
        assert "/new" not in topology.topics
    topology.declare("/new")
    topology.describe("u", "x" * 39)
    topology.declare("/new", "x")
    topology.undeclare("/old")
    topology.describe("v", "x" * 40)
    with pytest.raises(AddressError, match="at most 100"):
        topology.describe("v", "x" * 41)
