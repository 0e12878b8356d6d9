"""Messages that were kept."""

import numpy as np
from support.recordings import payload_of

import yarpy
from yarpy.kits.record.recorded import PortFacts, Recorded


def test_it_is_read_as_from_a_port() -> None:
    payload = payload_of(yarpy.Vector([1.5, 2.5]))
    one = Recorded("/a", 1_500_000_000, 250_000_000, "3 0.25", payload)
    assert one.value == yarpy.Vector([1.5, 2.5])
    assert one.as_(np.ndarray).tolist() == [1.5, 2.5]
    assert one.stamp == yarpy.Stamp(3, 0.25)
    assert (one.received, one.sent) == (1.5, 0.25)
    assert (one.message.source, one.message.payload) == ("/a", payload)
    assert repr(one).startswith("<Recorded 1.500000 <Message from /a [3 0.25]")


def test_without_an_envelope() -> None:
    assert Recorded("/a", 1, 1, "", payload_of([1])).stamp is None


def test_facts_of_two_ports_are_apart() -> None:
    PortFacts("/a").kinds.append("yarp/image")
    assert PortFacts("/b").kinds == []
