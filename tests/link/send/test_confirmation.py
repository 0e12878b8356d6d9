"""What is known of messages that nobody acknowledges: from answers, and from the peer's system."""

from __future__ import annotations

import pytest

from yarpy.link.send.confirmation import RECENT, Confirmation, Outcome


def test_without_a_witness_what_left_counts_as_carried() -> None:
    assert Confirmation().outcome(7, in_order=False) == Outcome(7, 0, 0)


def test_what_left_before_the_last_question_but_one_and_has_not_come_is_lost() -> None:
    found = Confirmation(True)
    found.told(100, 90)
    assert found.outcome(120, in_order=False) == Outcome(90, 0, 30), "they may be on their way"
    found.told(120, 112)
    assert found.outcome(150, in_order=False) == Outcome(112, 0, 38)
    found.told(150, 115)
    assert found.outcome(160, in_order=False) == Outcome(115, 5, 40)
    found.told(160, 160)
    assert found.outcome(160, in_order=False) == Outcome(160, 0, 0), "they were late, not lost"


def test_in_a_stream_nothing_is_lost_on_the_way() -> None:
    found = Confirmation(True)
    for _ in range(3):
        found.told(100, 90)
    assert found.outcome(120, in_order=True) == Outcome(90, 0, 30)


def test_more_came_than_had_left_when_we_asked() -> None:
    found = Confirmation(True)
    found.told(10, 12)
    assert found.outcome(11, in_order=False) == Outcome(11, 0, 0)
    assert found.outcome(13, in_order=False) == Outcome(12, 0, 1)


@pytest.mark.parametrize(
    ("taken", "came"), [(0, 0), (9, 0), (10, 1), (11, 1), (29, 2), (30, 3), (99, 3)]
)
def test_messages_whose_last_byte_was_read_have_come(taken: int, came: int) -> None:
    found = Confirmation(True)
    found.ends.extend((10, 20, 30))
    found.told(3, 3)
    assert found.end(3, taken) == Outcome(came, 0, 3 - came)


def test_what_is_further_back_than_we_remember_goes_by_size() -> None:
    found = Confirmation(True)
    found.ends.extend(range(10, 10 * 3 * RECENT + 1, 10))
    found.told(3 * RECENT, 3 * RECENT)
    assert found.end(3 * RECENT, 10 * 3 * RECENT) == Outcome(3 * RECENT, 0, 0)
    assert found.end(3 * RECENT, 10 * RECENT) == Outcome(RECENT, 0, 2 * RECENT)
    assert found.end(3 * RECENT, 0) == Outcome(0, 0, 3 * RECENT)


def test_a_system_that_confirms_does_not_tell_whether_its_program_has_read() -> None:
    found = Confirmation(True)
    found.ends.extend((10, 20, 30))
    found.told(3, 1)
    assert found.end(3, 20) == Outcome(1, 0, 2)
    assert found.end(3, 5) == Outcome(0, 0, 3)


def test_what_never_left_is_not_among_them() -> None:
    found = Confirmation(True)
    found.ends.extend((10, 20, 30))
    found.recall(2)
    found.told(1, 1)
    assert found.end(1, 10) == Outcome(1, 0, 0)
    found.recall(5)
    assert found.end(0, 10) == Outcome(0, 0, 0)
