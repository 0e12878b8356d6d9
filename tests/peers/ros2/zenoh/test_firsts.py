"""The first number of each publisher, heard for as long as one is silent."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.ros2.zenoh.firsts import Firsts
from yarpy.peers.zenoh.library import WAKE
from yarpy.peers.zenoh.transport import SharedSession, share

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')

KEY = "yarpy/firsts"
ONE, TWO, THREE = (bytes([number]) * 16 for number in (1, 2, 3))


@pytest.fixture
def shared(router: int) -> Iterator[SharedSession]:
    with share() as found:
        yield found


@pytest.fixture
def firsts(shared: SharedSession) -> Iterator[Firsts]:
    made = Firsts(shared.session, KEY, [ONE])
    yield made
    made.undeclare()
    made.undeclare()


def put(shared: SharedSession, publisher: bytes, *numbers: int) -> None:
    for number in numbers:
        shared.session.put(KEY, b"x", attachment=attachment(number, 1, publisher))


def listens(firsts: Firsts) -> bool:
    return firsts._handle is not None


def test_the_first_of_each(shared: SharedSession, firsts: Firsts) -> None:
    firsts.come(TWO)
    put(shared, ONE, 5, 6, 7)
    assert listens(firsts)  # to the other one
    put(shared, TWO, 1, 2)
    wait_until(lambda: not listens(firsts))
    assert firsts.first(ONE, 7) == 5
    assert firsts.first(TWO, 2) == 1
    assert firsts.first(THREE, 12) == 12  # of whom nothing was heard before
    assert firsts.first(ONE, 3) == 3  # kept by its publisher, and sent later


def test_who_comes_later(shared: SharedSession, firsts: Firsts) -> None:
    put(shared, ONE, 1)
    wait_until(lambda: not listens(firsts))
    firsts.come(ONE)  # told once more
    firsts.come(TWO)
    wait_until(lambda: listens(firsts))
    firsts.leave(TWO)
    wait_until(lambda: not listens(firsts))
    firsts.come(TWO)
    wait_until(lambda: listens(firsts))
    put(shared, TWO, 3, 4)
    wait_until(lambda: not listens(firsts))
    assert firsts.first(TWO, 4) == 3
    assert firsts.first(ONE, 9) == 1


def test_messages_and_token_of_different_gids(shared: SharedSession, firsts: Firsts) -> None:
    put(shared, THREE, 2)
    wait_until(lambda: not listens(firsts))
    assert firsts.first(THREE, 2) == 2


def test_what_has_no_number(shared: SharedSession, firsts: Firsts) -> None:
    shared.session.put(KEY, b"x")
    shared.session.delete(KEY, attachment=WAKE)
    put(shared, ONE, 4)
    wait_until(lambda: not listens(firsts))
    assert firsts.first(ONE, 5) == 4


def test_nothing_is_listened_to_after_the_end(firsts: Firsts) -> None:
    firsts.undeclare()
    firsts.come(TWO)
    wait_until(lambda: not firsts._turn._running)
    assert not listens(firsts)
