"""Policies of what a server lends: fresh or recycled first, habits, owners, exhaustion."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import AddressError
from yarpy.nameserver.pool import Pool


def numbers(first: int = 10, last: int = 13) -> Pool:
    return Pool("port numbers", first, last, recycle=False, remember=True)


def test_numbers_are_fresh_until_there_are_none() -> None:
    pool = numbers()
    assert pool.take("/a") == "10"
    pool.release("10", "/a")
    assert pool.take("/b") == "11"
    assert pool.take("/c") == "12"
    assert pool.take("/d") == "13"
    assert pool.take("/e") == "10", "the range is used up, so a freed number goes out again"
    with pytest.raises(AddressError, match="ran out of port numbers"):
        pool.take("/f")


def test_an_owner_gets_its_number_back_unless_somebody_else_had_it() -> None:
    pool = numbers(10, 14)
    for name in ("/a", "/b", "/c", "/d"):
        pool.take(name)
    pool.release("11", "/b")
    assert pool.take("/b") == "11"
    pool.release("11", "/b")
    pool.release("12", "/c")
    assert pool.take("/x") == "14"
    pool.release("14", "/x")
    assert pool.take("/y") == "11"
    assert pool.take("/b") == "12"
    assert pool.take("/x") == "14"
    with pytest.raises(AddressError):
        pool.take("/c")


def test_recycled_in_string_order() -> None:
    pool = Pool("numbers", 8, 20, recycle=False)
    for number in range(8, 21):
        pool.take(f"/{number}")
    for number in (9, 10, 8, 20):
        assert pool.release(str(number), f"/{number}")
    assert [pool.take("/n") for _ in range(4)] == ["10", "20", "8", "9"]


def test_temporary_names_are_recycled_first() -> None:
    pool = Pool("names", 1, 100, lambda n: f"/tmp/port/{n}")
    assert [pool.take(None) for _ in range(3)] == ["/tmp/port/1", "/tmp/port/2", "/tmp/port/3"]
    pool.release("/tmp/port/2", None)
    assert pool.take(None) == "/tmp/port/2"
    assert pool.take(None) == "/tmp/port/4"


def test_only_the_owner_gives_back() -> None:
    pool = numbers()
    pool.take("/a")
    assert not pool.release("10", "/b")
    assert not pool.release("12", "/a")
    assert (pool.lent("/a"), pool.lent("/b")) == ("10", None)
    assert pool.release("10", "/a")
    assert not pool.release("10", "/a")


def test_blocked_values_are_passed_over_and_not_lost() -> None:
    pool = numbers()
    assert pool.take("/a", lambda value: value == "10") == "11"
    assert pool.take("/b") == "12"
    assert pool.take("/c") == "13"
    with pytest.raises(AddressError):
        pool.take("/d", lambda value: value == "10")
    assert pool.take("/d") == "10"


def test_rows_and_restore_are_inverse() -> None:
    pool = numbers(10, 100)
    for name in ("/a", "/b", "/c"):
        pool.take(name)
    pool.release("11", "/b")
    assert sorted(pool.rows()) == [("10", True, "/a"), ("11", False, "/b"), ("12", True, "/c")]
    assert list(pool.rows(["99"])) == [("99", None, None)]
    copy = numbers(10, 100)
    copy.restore(pool.counter, pool.rows())
    assert sorted(copy.rows()) == sorted(pool.rows())
    assert copy.take("/new") == "13"
    assert copy.take("/b") == "11"


def test_a_number_from_an_old_file_of_unknown_owner_can_be_given_back() -> None:
    pool = numbers()
    pool.restore(11, [("10", True, None), ("11", True, "/b")])
    assert pool.release("10", "/anybody")
    assert not pool.release("11", "/anybody")


def test_a_counter_beyond_the_range_is_cut() -> None:
    pool = numbers()
    pool.restore(99999, [])
    assert pool.counter == 13


@given(st.lists(st.tuples(st.booleans(), st.sampled_from("abcdefgh")), max_size=60))
def test_nothing_is_lent_twice(steps: list[tuple[bool, str]]) -> None:
    for recycle, remember in ((True, False), (False, True)):
        pool = Pool("things", 1, 5, recycle=recycle, remember=remember)
        held: dict[str, str] = {}
        for take, owner in steps:
            if take and owner not in held:
                try:
                    value = pool.take(owner)
                except AddressError:
                    assert len(held) == 5
                    continue
                assert value not in held.values()
                held[owner] = value
            elif not take and owner in held:
                assert pool.release(held.pop(owner), owner)
        assert {v: o for v, used, o in pool.rows() if used and remember} == (
            {v: o for o, v in held.items()} if remember else {}
        )
