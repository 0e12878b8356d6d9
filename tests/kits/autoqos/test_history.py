"""What a governor remembers: the changes in force, and the measures that rest."""

from yarpy.kits.autoqos.change import Change
from yarpy.kits.autoqos.history import FLOOD, LONGEST_REST, REST, History
from yarpy.kits.autoqos.rules import Rule

RULE = Rule("critical", ("/a -> /b",), line=3)
OTHER = Rule("critical", ("/c -> /d",), line=9)


def limit(value: float | None, before: float | None, peer: str = "/b") -> Change:
    return Change("/a", peer, "limit", value, before)


def test_a_setting_is_remembered_from_what_was_there_at_first() -> None:
    history = History()
    for value, before in ((50.0, None), (25.0, 50.0), (10.0, 25.0)):
        history.add(limit(value, before))
    assert history.changes == [limit(10.0, None)]
    assert history.now(limit(1.0, None)) == 10.0
    history.add(limit(None, 10.0))  # as it was
    assert history.changes == []
    assert history.now(limit(1.0, 77.0)) == 77.0  # what the change itself knows


def test_the_limit_of_a_connection_or_of_its_sender() -> None:
    history = History()
    assert history.limit_of(("/a", "/b")) is None
    history.add(limit(8.0, None))
    assert history.limit_of(("/a", "/b")) == 8.0 and history.limit_of(("/a", "/x")) is None
    history = History()
    history.add(limit(5.0, None, peer="/a"))  # for all that it writes
    assert history.limit_of(("/a", "/b")) == history.limit_of(("/a", "/x")) == 5.0


def test_all_of_the_way_back() -> None:
    history = History()
    history.add(limit(50.0, None))
    history.add(limit(25.0, 50.0))
    gone = Change("/a", "/b", "packets", "LOW", "NORM")
    assert history.all_undone((limit(25.0, 50.0), gone)) == (limit(None, 25.0),)


def test_what_did_not_help_rests_for_longer_each_time() -> None:
    history = History()
    assert not history.rests(RULE, "packets", 0.0)
    now = 0.0
    for rest in (REST, 2 * REST, 4 * REST):
        history.failed(RULE, "packets", now)
        assert history.rests(RULE, "packets", now + rest - 1)
        assert not history.rests(RULE, "packets", now + rest)
        now += rest
    for _ in range(20):
        history.failed(RULE, "packets", now)
    assert history.rests(RULE, "packets", now + LONGEST_REST - 1)
    assert not history.rests(RULE, "packets", now + LONGEST_REST)
    assert not history.rests(RULE, "threads", now) and not history.rests(OTHER, "packets", now)


def test_what_helps_lets_the_others_of_its_rule_be_tried_but_not_a_flood() -> None:
    history = History()
    for rule, measure in ((RULE, "packets"), (RULE, FLOOD), (OTHER, "packets")):
        history.failed(rule, measure, 0.0)
    history.helped(RULE, "threads")
    assert not history.rests(RULE, "packets", 1.0)
    assert history.rests(RULE, FLOOD, 1.0) and history.rests(OTHER, "packets", 1.0)
    history.failed(RULE, "threads", 0.0)
    history.helped(RULE, "threads")
    history.failed(RULE, "threads", 0.0)
    assert not history.rests(RULE, "threads", REST)  # it begins anew
