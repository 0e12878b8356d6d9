"""The equations of arbitration: decay, neurons, links, and the runs recorded from C++ YARP."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.monitors.arbitration import Competitor, Contest, Inconsistent


def runs(competitors: list[Competitor], *events: tuple[float, Competitor]) -> list[bool]:
    contest = Contest(competitors)
    return [contest.decide(one, at) for at, one in events]


# -- stimulation ----------------------------------------------------------------------------------


def test_stimulation_decays_to_nothing() -> None:
    one = Competitor("/a", fade=2.0, strength=0.8)
    one.stimulate(10.0)
    assert one.stimulation(10.0) == pytest.approx(0.8)
    assert one.stimulation(11.0) == pytest.approx(0.8 * (1 - exp(-2.5) + exp(-5)))
    assert one.stimulation(12.0) == pytest.approx(0.8 * exp(-5))
    assert one.stimulation(12.001) == 0


def test_messages_add_up_to_the_threshold() -> None:
    one = Competitor("/a", strength=0.5)
    assert runs([one], (0.0, one), (0.4, one)) == [False, False]
    assert one.stimulus == pytest.approx(0.98, abs=0.005)
    assert runs([one], (0.8, one)) == [True]
    assert one.stimulus == 1


def test_neuron_fires_rests_and_recovers() -> None:
    """Recorded: a message every 0.4 s, st 5, tc 1, tr 1."""
    one = Competitor("/a", strength=0.5, fade=1.0, rest=1.0)
    got = runs([one], *((0.4002 * n, one) for n in range(12)))
    assert got == [False] * 2 + [True] * 3 + [False] * 4 + [True] * 3


def test_neuron_keeps_its_level_while_it_fires() -> None:
    one = Competitor("/a", rest=1.0)
    one.stimulate(0.0)
    assert [one.stimulation(at) for at in (0.1, 0.5, 0.99)] == [1, 1, 1]
    one.stimulate(0.5)  # leaves it cold
    assert one.since == 0
    assert one.stimulation(1.0) == pytest.approx(-1)
    assert not one.active
    assert one.stimulation(1.5) == pytest.approx(-(1 - exp(-2.5) + exp(-5)))
    one.stimulate(1.9)
    assert not one.active
    one.stimulate(2.1)
    assert one.active


@pytest.mark.parametrize("rest", [0.0, 0.5])
def test_no_time_at_all_is_a_moment(rest: float) -> None:
    one = Competitor("/a", fade=0.0, rest=rest)
    assert runs([one], (1.0, one)) == [rest == 0]
    assert one.stimulation(1.1) <= 0


# -- the contest ----------------------------------------------------------------------------------


def test_recorded_contest() -> None:
    """A bias 10, B bias 5; then A bias 0.2; then V excites A and inhibits B."""
    a, b = Competitor("/pa", bias=1.0), Competitor("/pb", bias=0.5)
    two = [a, b]
    assert runs(two, (0.0, b)) == [True]
    assert runs(two, (0.5, a), (0.6, b), (0.7, a)) == [True, False, True]
    assert runs(two, (2.0, b)) == [True]  # 1.3 s after A's last
    a.bias = 0.2
    assert runs(two, (2.1, a), (2.2, b)) == [False, True]
    v = Competitor("/pv", fade=2.0, weights=(("/pb", -1.0), ("/pa", 1.0)), virtual=True)
    three = [a, b, v]
    assert runs(three, (2.3, v), (2.4, a), (2.5, b)) == [False, True, False]
    assert Contest(three).outcome(2.5).outputs == pytest.approx({"/pa": 1.2, "/pb": -0.5, "/pv": 1})
    assert runs(three, (4.4, b), (4.5, a), (4.6, b)) == [True, False, True]  # V has decayed


def test_nobody_wins_without_something_to_say() -> None:
    a, b = Competitor("/a", bias=-1.0), Competitor("/b", bias=0.0)
    assert runs([a, b], (0.0, a), (0.0, b)) == [False, False]
    assert Contest([a, b]).outcome(0.1).winner is None
    assert Contest().outcome(0.0).winner is None


def test_tie_goes_to_who_came_first() -> None:
    a, b = Competitor("/a"), Competitor("/b")
    assert runs([a, b], (0.0, b), (0.1, a), (0.2, b)) == [True, True, False]


def test_link_to_itself_is_part_of_the_fixed_point() -> None:
    one = Competitor("/a", bias=1.0, weights=(("/a", 0.5),))
    assert runs([one], (0.0, one)) == [True]
    assert Contest([one]).outcome(0.0).outputs == {"/a": pytest.approx(2.0)}


def test_circle_of_excitement_has_no_solution() -> None:
    a = Competitor("/a", weights=(("/b", 1.0),))
    b = Competitor("/b", weights=(("/a", 1.0),))
    assert runs([a, b], (0.0, a)) == [True]
    with pytest.raises(Inconsistent):
        Contest([a, b]).decide(b, 0.1)
    assert runs([a, b], (2.0, a)) == [True]  # alone again


WEIGHT = st.integers(-20, 20).map(lambda n: n / 10)


@given(st.data(), st.integers(1, 6))
def test_outputs_are_those_of_linear_algebra(data: st.DataObject, size: int) -> None:
    names = [f"/{n}" for n in range(size)]
    peers = [
        Competitor(
            name,
            bias=data.draw(WEIGHT),
            weights=tuple(
                (other, data.draw(WEIGHT)) for other in names if data.draw(st.booleans())
            ),
            virtual=data.draw(st.booleans()),
        )
        for name in names
    ]
    x = np.array([data.draw(st.booleans()) for _ in names], dtype=float)
    for one, active in zip(peers, x, strict=True):
        if active:
            one.stimulate(5.0)
    matrix = np.eye(size)
    for j, one in enumerate(peers):
        for target, weight in one.weights:
            matrix[names.index(target), j] -= weight * x[names.index(target)]
    # Only those who are active act.
    matrix[:, x == 0] = np.eye(size)[:, x == 0]
    if abs(np.linalg.det(matrix)) < 1e-6:
        return
    wanted = np.linalg.solve(matrix, np.array([one.bias for one in peers]) * x) * x
    outcome = Contest(peers).outcome(5.0)
    outputs = [outcome.outputs.get(one.source, 0.0) for one in peers]
    assert outputs == pytest.approx(list(wanted), abs=1e-6)
    able = [w if not one.virtual else -1.0 for w, one in zip(wanted, peers, strict=True)]
    if outcome.winner is not None:
        assert outcome.outputs[outcome.winner.source] == pytest.approx(max(able), abs=1e-6)
    else:
        assert max(able) <= 1e-9


@given(st.lists(st.tuples(st.floats(0, 5), st.integers(0, 2)), max_size=40), st.floats(0, 2))
def test_at_most_one_may_speak(steps: list[tuple[float, int]], rest: float) -> None:
    """What is remembered of earlier outcomes is what would be worked out anew."""
    peers = [Competitor(f"/{n}", bias=n + 1, rest=rest, strength=0.4 + n / 5) for n in range(3)]
    contest, now = Contest(peers), 0.0
    for wait, who in steps:
        now += wait
        passed = contest.decide(peers[who], now)
        outcome = Contest(peers).outcome(now)
        assert passed == (outcome.winner is peers[who])
        assert contest.outcome(now) == outcome
        assert [one.active for one in peers] == [
            one.stimulation(now) > 0 and one.active for one in peers
        ]
        assert all(-1 <= one.stimulus <= 1 for one in peers)


def test_changes_count_once_they_are_told() -> None:
    a, b = Competitor("/a"), Competitor("/b", bias=0.5)
    contest = Contest([a, b])
    assert [contest.decide(a, 0.0), contest.decide(b, 0.0)] == [True, False]
    b.bias = 2.0
    contest.changed()
    assert [contest.decide(a, 0.0), contest.decide(b, 0.0)] == [False, True]


def test_what_is_remembered_is_bounded() -> None:
    peers = [Competitor(f"/{n}", bias=n + 1) for n in range(12)]
    contest = Contest(peers)
    for mask in range(1 << 12):
        for n, one in enumerate(peers):
            one.active = bool(mask >> n & 1)
        contest.outcome(0.0)
    assert len(contest._outcomes) <= 1024
