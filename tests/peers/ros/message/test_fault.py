"""What does not fit is told with the path of its field."""

from typing import Any

import numpy as np
import pytest

from yarpy.peers.ros.message.fault import array_of, fault
from yarpy.peers.ros.message.library import Library


@pytest.mark.parametrize(
    ("field", "value", "kind", "said"),
    [
        ("i8", 128, OverflowError, "i8: 128 does not fit in int8"),
        ("u64", -1, OverflowError, "u64: -1 does not fit in uint64"),
        ("u64", 1 << 64, OverflowError, "does not fit in uint64"),
        ("i32", 1.5, TypeError, "i32: expected int32, got 1.5"),
        ("i32", "3", TypeError, "i32: expected int32, got '3'"),
        ("f64", "3", TypeError, "f64: expected float64, got '3'"),
        ("f64", None, TypeError, "f64: expected float64, got None"),
        ("f32", 1e300, OverflowError, "f32: 1e+300 does not fit in float32"),
        ("text", 3, TypeError, "text: expected a string, got 3"),
        ("text", b"abc", TypeError, "text: expected a string, got a bytes"),
        ("text", "\ud800", TypeError, "text: text that cannot be sent"),
        ("stamp", "3", TypeError, "stamp: expected time or seconds, got '3'"),
        ("stamp", True, TypeError, "stamp: expected time or seconds, got True"),
        ("stamp", float("nan"), TypeError, "stamp: expected time or seconds, got nan"),
        ("stamp", -0.5, OverflowError, "stamp.secs: -1 does not fit in time"),
        ("span", 1e10, OverflowError, "span.secs: 10000000000 does not fit in duration"),
        ("texts", "abc", TypeError, "texts: expected a list, got 'abc'"),
        ("texts", ["a", 1], TypeError, r"texts[1]: expected a string, got 1"),
        ("words", ["a"], TypeError, "words: 2 elements are wanted, here are 1"),
        ("f64s", [1.0], TypeError, "f64s: 2 elements are wanted, here are 1"),
        ("f32s", [[1.0, 2.0]], TypeError, "f32s: expected a list of numbers, got the shape (1, 2)"),
        ("f64s", [1.0, "x"], TypeError, "f64s: expected float64 numbers, got 'x'"),
        ("i32s", [1.5], TypeError, "i32s: expected int32 numbers, got float64 numbers"),
        ("i32s", [[1], [1, 2]], TypeError, "i32s: expected int32 numbers"),
        ("u8s", [256], OverflowError, "u8s: a number that does not fit in uint8"),
        ("u16s", b"ab", TypeError, "u16s: expected uint16 numbers, got bytes"),
        ("flags", [2], TypeError, "flags: expected bool numbers, got int"),
        ("inner", 3, TypeError, "inner: expected test/Inner, got 3"),
        ("pair", [None, None], TypeError, "pair[0]: expected test/Inner, got None"),
        ("stamps", ["1"], TypeError, "stamps[0]: expected time or seconds, got '1'"),
        ("inners", 7, TypeError, "inners: expected a list, got 7"),
    ],
)
def test_errors_name_the_field(
    library: Library, field: str, value: Any, kind: type[Exception], said: str
) -> None:
    every = library.message("test/Every")(**{field: value})
    for send in (every.to_ros, every.to_wire):
        with pytest.raises(kind) as caught:
            send()
        assert str(caught.value).startswith("test/Every.")
        assert said in str(caught.value)


def test_a_message_of_another_type_is_named(library: Library) -> None:
    every = library.message("test/Every")(inner=library.message("std_msgs/String")())
    with pytest.raises(TypeError, match=r"expected test/Inner, got a std_msgs/String"):
        every.to_ros()


def test_nothing_is_wrong_with_what_fits(library: Library) -> None:
    every = library.message("test/Every")
    assert fault(every._definition.struct, every()) is None


def test_arrays_are_not_copied_without_need() -> None:
    numbers = np.arange(3.0)
    assert array_of(numbers, np.dtype("<f8"), "x") is numbers
    assert array_of([], np.dtype("<f8"), "x").dtype == "f8"
    assert array_of(b"ab", np.dtype("u1"), "x").tolist() == [97, 98]
