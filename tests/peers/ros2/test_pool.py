"""What topics share is opened once, and ended by the last of them."""

from __future__ import annotations

import pytest

from yarpy.peers.ros2.pool import Pool


class Part:
    """Notes what becomes of it."""

    def __init__(self, key: int) -> None:
        if key < 0:
            raise ValueError(key)
        self.key, self.users, self.broken, self.ends = key, 0, False, 0

    def end(self) -> None:
        self.ends += 1

    def ended(self) -> bool:
        return self.broken


def test_it_is_opened_once_and_ended_by_the_last() -> None:
    pool = Pool(Part)
    first = pool.take(1)
    assert pool.take(1) is first and pool.take(2) is not first
    pool.leave(first)
    assert (first.users, first.ends) == (1, 0)
    pool.leave(first)
    assert (first.users, first.ends) == (0, 1)
    assert pool.take(1) is not first


def test_one_that_broke_is_not_handed_out_and_does_not_end_its_successor() -> None:
    pool = Pool(Part)
    first = pool.take(1)
    first.broken = True
    second = pool.take(1)
    assert second is not first
    pool.leave(first)
    assert first.ends == 1 and pool.take(1) is second and second.users == 2


def test_what_could_not_be_opened_is_tried_again() -> None:
    pool = Pool(Part)
    for _ in range(2):
        with pytest.raises(ValueError):
            pool.take(-1)


def test_a_forked_process_has_nothing() -> None:
    pool = Pool(Part)
    first = pool.take(1)
    pool.forget()
    assert pool.take(1) is not first and first.ends == 0
