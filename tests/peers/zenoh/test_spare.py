"""Memory that is used again for what is put into Zenoh."""

from __future__ import annotations

from yarpy.peers.zenoh.spare import LARGE, POOLED, Spare


def test_a_large_message_takes_the_memory_of_the_one_before() -> None:
    spare = Spare()
    one = spare.join([b"head", bytes(LARGE)])
    assert one == b"head" + bytes(LARGE)
    spare.give_back(one)
    two = spare.join([b"next", memoryview(b"x" * LARGE)])
    assert two is one and two == b"next" + b"x" * LARGE


def test_memory_that_is_in_use_is_not_used_twice() -> None:
    spare = Spare()
    one, two = (spare.join([text, bytes(LARGE)]) for text in (b"1", b"2"))
    assert one is not two and one[:1] == b"1" and two[:1] == b"2"


def test_little_is_kept_and_nothing_that_others_may_have() -> None:
    spare = Spare()
    small = spare.join([b"a", b"b"])
    spare.give_back(small)
    assert small == b"ab" and type(small) is bytes
    for size in range(LARGE, LARGE + 10):
        spare.give_back(spare.join([bytes(size)]))
        assert len(spare._free) <= POOLED
