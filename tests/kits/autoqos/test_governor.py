"""The governor, from made-up looks at a network."""

from __future__ import annotations

from support.steering import BULK, LOOP, RULES, Network


def count(steps: list[str], words: str) -> int:
    return sum(words in step for step in steps)


def test_a_quiet_network_is_left_alone_but_for_counting() -> None:
    network = Network()
    steps = network.run(30)
    assert len(steps) == 1
    assert "deadlines of 10 ms are counted on /control -> /motors" in steps[0]
    assert [*network.settings] == [("/motors", "/control", "timing")]


def test_packets_first_and_what_helps_stays() -> None:
    network = Network()
    network.late = lambda: 0.0 if network.has("packets") else 0.6
    steps = network.run(4)
    assert count(steps, "packets become HIGH") == 1
    assert count(steps, "that helped: 60% -> 0% late") == 1
    assert network.has("packets") and not network.has("threads")
    assert network.run(300) == []  # and so it stays


def test_it_is_under_control_within_three_seconds() -> None:
    network = Network()
    network.run(2)
    network.late = lambda: 0.6 - 0.3 * network.has("packets") - 0.3 * network.has("threads")
    network.run(3)
    assert network.has("packets") and network.has("threads")


def test_what_does_not_help_is_taken_back_and_rests_for_longer_each_time() -> None:
    network = Network()
    network.late = lambda: 0.0 if network.has("threads") else 0.5
    steps = network.run(8)
    assert count(steps, "that did not help (") == 1
    assert not network.has("packets") and network.has("threads")
    network = Network()
    network.late = lambda: 0.5  # nothing ever helps
    network.run(600)
    tried = count(network.steps, "packets become HIGH")
    assert 3 <= tried <= 5  # after 60, 120, 240 seconds, not 200 times
    assert count(network.steps, "nothing more can be done") <= 11
    assert {key for _, _, key in network.settings} <= {"timing", "limit", "packets", "threads"}


def test_a_step_is_not_judged_before_something_came() -> None:
    network = Network()
    network.late = lambda: 0.6
    while not network.has("packets"):
        network.run(0.25)
    network.rates[LOOP] = 0.0  # a stall
    assert network.run(3) == []
    network.rates[LOOP] = 100.0
    network.late = lambda: 0.0
    assert count(network.run(2), "that helped") == 1
    network = Network()
    network.late = lambda: 0.6
    while not network.has("packets"):
        network.run(0.25)
    network.rates[LOOP] = 0.0  # for good: perhaps that was us
    assert count(network.run(8), "did not help (nothing comes): it is as it was") == 1


def test_a_slow_stream_is_judged_on_many_messages() -> None:
    network = Network()
    network.rates[LOOP] = 5.0
    network.run(10)
    number = iter(range(10_000))
    network.late = lambda: 0.8 if next(number) % 80 == 0 else 0.0  # one message in a hundred
    assert count(network.run(60), "late on") == 0
    network.late = lambda: 0.5
    taken = network.run(20)
    assert count(taken, "its packets become HIGH") == 1
    network.late = lambda: 0.8 if next(number) % 8 == 0 else 0.5  # the first ones may be on time
    since = network.now
    while count(network.run(0.25), "did not help") == 0:
        assert network.now - since < 30
    assert network.now - since > 5, "that was told of a handful of messages"


def test_one_thing_at_a_time() -> None:
    network = Network()
    seen: list[int] = []
    network.late = lambda: 0.5
    before = 0
    for _ in range(400):
        network.run(0.25)
        seen.append(network.governor.steps - before)
        before = network.governor.steps
    assert max(seen) == 1


def test_bulk_pays_when_priorities_do_not_help_but_never_below_its_minimum() -> None:
    network = Network()
    key = ("/cam", "/cam", "limit")

    def late() -> float:
        limit = network.settings.get(key, 40.0)
        network.mbit[BULK] = min(40.0, limit)
        return min(1.0, limit / 40.0)

    network.late = late
    network.run(120)
    assert network.settings[key] == 2.0
    limits = [step for step in network.steps if "instead of" in step]
    assert 3 <= len(limits) <= 12


def test_limits_shrink_on_where_the_first_ones_do_not_help() -> None:
    network = Network()
    key = ("/cam", "/cam", "limit")

    def late(enough: float) -> float:
        network.mbit[BULK] = min(40.0, network.settings.get(key, 40.0))
        return 1.0 if network.mbit[BULK] > enough else 0.0

    network.late = lambda: late(8.0)
    network.run(25)
    assert network.settings[key] < 8.0
    assert count(network.steps, "that helped") == 1
    network = Network()
    network.late = lambda: late(0.0)  # nothing ever helps
    network.run(40)
    assert key not in network.settings  # and so it is as it was
    assert count(network.steps, "instead of") == 6


def test_limits_grow_again_when_it_is_calm_and_come_back_when_that_was_too_early() -> None:
    network = Network()
    key = ("/cam", "/cam", "limit")
    full = [10.0]  # Mbit/s that bulk may send before the loop is late

    def late() -> float:
        network.mbit[BULK] = min(40.0, network.settings.get(key, 40.0))
        return max(0.0, min(1.0, (network.mbit[BULK] - full[0]) / 20))

    network.late = late
    network.run(40)
    assert 2.0 < network.settings[key] < 11
    before = len(network.steps)
    network.run(200)
    early = count(network.steps[before:], "too early")
    assert 1 <= early <= 4  # it waits twice as long each time
    assert network.mbit[BULK] <= 16
    full[0], calm = 100.0, network.now
    while key in network.settings:  # until it is as it was
        network.run(10)
        assert network.now < calm + 2000


def test_what_is_refused_is_not_asked_again_and_the_next_measure_is_tried() -> None:
    network = Network()
    network.refuses["packets"] = "no"
    network.late = lambda: 0.0 if network.has("threads") else 0.5
    steps = network.run(10)
    assert network.has("threads")
    assert count(steps, "its packets become HIGH") == 1


def test_nobody_may_set_real_time_threads() -> None:
    network = Network()
    network.refuses["threads"] = "the system refuses real-time scheduling"
    network.late = lambda: 0.3 if network.has("packets") else 0.6
    network.run(200)
    assert network.has("packets") and not network.has("threads")
    assert count(network.steps, "SCHED_FIFO") <= 2


def test_a_carrier_that_bulk_may_be_moved_to() -> None:
    network = Network(RULES + 'carrier = "tcp+send.adaptive"\n')
    network.late = lambda: 0.0 if network.has("carrier", BULK) else 0.5
    network.run(20)
    assert network.settings[("/cam", "/viewer", "carrier")] == "tcp+send.adaptive"
    assert not network.has("packets")


def test_best_effort_keeps_its_minimum_under_a_critical_flood() -> None:
    network = Network()
    network.run(2)
    for port, peer in (LOOP, LOOP[::-1]):
        network.settings[(port, peer, "packets")] = "AF42"
    network.mbit.update({LOOP: 45.0, BULK: 0.2})
    network.run(2.5)
    assert count(network.steps, "/cam -> /viewer gets 0.2 of its 2 Mbit/s") == 1
    assert not network.has("packets")
    network.run(3)  # that was not enough: the flood sends less
    assert network.settings[("/control", "/control", "limit")] < 45


def test_a_flood_is_not_helped_when_it_is_late_for_its_own_size() -> None:
    network = Network()
    network.run(2)
    for port, peer in (LOOP, LOOP[::-1]):
        network.settings[(port, peer, "packets")] = "AF42"
    network.mbit.update({LOOP: 45.0, BULK: 0.2})
    network.late = lambda: 0.9
    network.run(6)
    assert not network.has("packets")
    network.mbit[BULK] = 20.0
    assert count(network.run(40), "become") == 0
    assert not network.has("packets") and not network.has("threads")


def test_best_effort_near_its_minimum_keeps_its_class() -> None:
    network = Network(RULES.replace("least = 2.0", "least = 35.0"))
    network.late = lambda: 0.5
    network.run(20)
    assert count(network.steps, "become LOW") == 0


def test_best_effort_that_has_nothing_to_send_does_not_starve() -> None:
    network = Network()
    network.held_up.clear()
    network.mbit.update({LOOP: 45.0, BULK: 0.0})
    assert len(network.run(30)) == 1


def test_a_sender_that_does_not_even_answer_is_thought_to_starve() -> None:
    network = Network()
    network.run(2)
    for port, peer in (LOOP, LOOP[::-1]):
        network.settings[(port, peer, "packets")] = "AF42"
    network.mbit.update({LOOP: 45.0, BULK: 0.0})
    network.silent.add("/cam")
    network.run(4)
    assert not network.has("packets")


def test_where_nobody_counts_priority_is_given_once_and_nobody_else_pays() -> None:
    network = Network()
    network.counts = False
    steps = network.run(100)
    assert count(steps, "counts no deadlines") == 1
    assert network.has("packets") and network.has("threads")
    assert not network.has("packets", BULK)
    assert network.governor.steps == 2


def test_contradictions_and_rules_that_match_nothing_are_told_once() -> None:
    network = Network(
        '[[critical]]\nconnections = ["/control"]\ndeadline = 0.01\n'
        '[[best-effort]]\nconnections = ["/motors"]\n'
        '[[best-effort]]\nconnections = ["/nobody/*"]\n'
    )
    network.late = lambda: 1.0
    steps = network.run(30)
    assert count(steps, "critical and best effort (lines 1 and 4") == 1
    assert count(steps, "line 6 (/nobody/*) matches no connection") == 1
    assert count(steps, "matches no connection") == 1, "those at odds do match one"
    assert network.settings == {}


def test_a_dry_run_says_each_thing_once() -> None:
    network = Network(trusting=True)
    network.counts = False
    network.make = lambda change: None  # type: ignore[method-assign]
    steps = network.run(100)
    assert count(steps, "HIGH") == 1 and count(steps, "SCHED_FIFO") == 1
