"""What a measure changes, and what it leaves alone."""

from __future__ import annotations

import pytest
from support.steering import BULK, LOOP, Network

from yarpy.kits.autoqos import measures
from yarpy.kits.autoqos.change import Change
from yarpy.network.traffic import End, Flow
from yarpy.qos import Qos


def flow(sender: Qos, receiver: Qos) -> Flow:
    return Flow("/a", "/b", End("tcp", qos=sender), End("tcp", qos=receiver))


def test_packets_of_both_ends_unless_they_are_beyond() -> None:
    found = measures.packets([flow(Qos(packets="NORM"), Qos(packets="VA"))], "AF42", True)
    assert found == (Change("/a", "/b", "packets", "AF42", "CS0"),)
    found = measures.packets([flow(Qos(packets="NORM"), Qos(packets="LOW"))], "AF11", False)
    assert found == (Change("/a", "/b", "packets", "AF11", "CS0"),)
    assert measures.packets([flow(Qos(), Qos())], "AF42", True) == ()  # nobody knows


def test_threads_that_are_not_in_real_time() -> None:
    found = measures.threads([flow(Qos("SCHED_RR", 5), Qos("SCHED_OTHER", 0))])
    assert found == (Change("/b", "/a", "threads", ("SCHED_FIFO", 30), ("SCHED_OTHER", 0)),)


def test_deadlines_are_counted_where_somebody_can_and_does_not() -> None:
    one = flow(Qos(), Qos())
    assert measures.timing(one, 0.01, 50) == ()
    assert one.receiver is not None
    one.receiver.messages = 0
    assert measures.timing(one, 0.01, 50) == (Change("/b", "/a", "timing", (0.01, 50), (0.0, 0.0)),)
    one.receiver.timing = {"missed": 0}
    assert measures.timing(one, 0.01, 50) == ()


def test_another_carrier() -> None:
    one = flow(Qos(), Qos())
    assert measures.carrier([one], "") == ()
    assert measures.carrier([one], "tcp") == ()
    assert measures.carrier([one], "udp") == (Change("/a", "/b", "carrier", "udp", "tcp"),)


@pytest.mark.parametrize(
    ("mbit", "least", "expected"), [(40.0, 2.0, 24.0), (3.0, 2.0, 2.0), (1.0, 2.0, None)]
)
def test_less_but_never_below_the_minimum(
    mbit: float, least: float, expected: float | None
) -> None:
    snapshot = Network().snapshot()
    found = measures.limit(snapshot, snapshot.flows[BULK], mbit, least, True)
    assert [one.value for one in found] == ([] if expected is None else [expected])


def test_who_cannot_be_limited() -> None:
    snapshot = Network().snapshot()
    one = snapshot.flows[BULK]
    assert one.sender is not None
    assert measures.limit(snapshot, one, 40, 2, alone=False) == ()  # it sends to others too
    one.sender.dropped = {"Throttle of the port": 3}  # another monitor sits there
    assert measures.limit(snapshot, one, 40, 2, alone=True) == ()
    one.sender.monitors, one.sender.parameters = ["adaptive"], {"mbit": 30.0}
    assert measures.limit(snapshot, one, 40, 2, alone=False) == (
        Change("/cam", "/viewer", "limit", 24.0, 30.0),
    )
    snapshot.ports["/cam"].ours = False
    assert measures.limit(snapshot, one, 40, 2, alone=True) == ()


def test_changes_of_a_connection() -> None:
    own = Change(*LOOP, "packets", "AF11", "CS0")
    others = [Change(*BULK, "packets", "AF11", "CS0"), Change(*LOOP, "threads", 1, 2)]
    assert measures.changes_of([own, *others], "packets", {LOOP}) == [own]
