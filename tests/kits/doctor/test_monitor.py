"""Findings about monitors; test_examination.py has the faults."""

from support.doctor import made_up

from yarpy.kits.doctor.monitor import find
from yarpy.network.traffic import End, Flow


def test_one_that_thins_out_is_no_fault() -> None:
    end = End(messages=9, delivered=3, dropped={"throttleDown": 6})
    assert [*find(made_up(Flow("/a", "/b", None, end)))] == []


def test_one_that_fails_now_and_then_is_a_warning() -> None:
    end = End(messages=9, delivered=3, dropped={"x": 6, "y": 0}, failures={"x": "odd"})
    [finding] = find(made_up(Flow("/a", "/b", None, end)))
    assert (finding.level, "drops 6 of 9 messages: odd" in finding.verdict) == ("warning", True)


def test_the_winner_itself_is_not_starved() -> None:
    end = End(messages=9, delivered=3, dropped={"priority": 6}, state={"winner": "/a"})
    assert [*find(made_up(Flow("/a", "/b", None, end)))] == []
