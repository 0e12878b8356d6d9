"""Numbers out of messages: which, when, how many, and what is said of the others."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import yarpy
from yarpy.kits.views.trace import (
    AT_ONCE,
    CURVES,
    HISTORY,
    LEAVES,
    MEMORY,
    TRUST,
    Clock,
    Trace,
    flat,
    leaves_of,
    number_of,
    parse_indices,
)


def message(value: Any, envelope: str = "") -> yarpy.Message:
    payload = value if isinstance(value, bytes) else yarpy.Bottle(value).to_bytes()
    return yarpy.Message("D", payload, envelope)


def traced(*values: Any, indices: tuple[int, ...] = ()) -> tuple[Trace, dict[str, Any]]:
    trace = Trace("/x", indices)
    for second, value in enumerate(values):
        trace.take(message(value), float(second))
    return trace, trace.told(0, float(len(values)))


def test_curves_and_rows() -> None:
    _, told = traced([1, 2.5, -3], [4, 5, 6])
    assert told["curves"] == [{"index": i, "label": "", "unit": ""} for i in range(3)]
    assert told["rows"] == [(0.0, 1, 2.5, -3), (1.0, 4, 5, 6)]
    assert (told["next"], told["total"], told["rate"]) == (2, 2, 1.0)
    assert (told["more"], told["others"], told["empty"], told["complaint"]) == (0, [], 0, "")


@pytest.mark.parametrize(
    ("value", "row"),
    [
        (yarpy.Vector([1.5, 2.5]), (1.5, 2.5)),
        (yarpy.Vector([7, 8], dtype="int32"), (7, 8)),
        (yarpy.Matrix(np.array([[1.0, 2.0], [3.0, 4.0]])), (2, 2, 1.0, 2.0, 3.0, 4.0)),
        ([[1, [2, [3]]], 4], (1, 2, 3, 4)),
        ([True, False, 5], (1, 0, 5)),
        ([math.nan, 1.0], (1.0,)),
        ([math.inf, 1.0], (1.0,)),
        (yarpy.Stamp(7, 1.5), (7, 1.5)),
        ([1 << 60], (1 << 60,)),
    ],
)
def test_numbers(value: Any, row: tuple[float, ...]) -> None:
    payload = b"".join(map(bytes, value.to_wire())) if hasattr(value, "to_wire") else value
    _, told = traced(payload)
    assert told["rows"] == [(0.0, *row)]
    assert all(type(number) in (int, float) for number in told["rows"][0])


def test_what_comes_from_the_same_program() -> None:
    trace = Trace("/x")
    trace.take(yarpy.Message("D", {"a": 1, "b": np.array([2.0, 3.0])}, spelling="object"), 0.0)
    assert trace.told(0, 1.0)["rows"] == [(0.0, 1, 2.0, 3.0)]


@pytest.mark.parametrize(
    ("value", "row"),
    [
        (np.arange(4, dtype="f2").reshape(1, 2, 2), (0.0, 1.0, 2.0, 3.0)),
        (np.array([True, False]), (1, 0)),
        ({"a": 1, "b": np.array([2, 3], "u1"), "c": {"d": 4.0}}, (1, 2, 3, 4.0)),
    ],
)
def test_arrays_of_every_type_and_dicts_of_them(value: Any, row: tuple[float, ...]) -> None:
    trace = Trace("/x")
    trace.take(yarpy.Message("D", value, spelling="object"), 0.0)
    assert trace.told(0, 1.0)["rows"] == [(0.0, *row)]


def test_what_is_no_number_is_skipped_and_told() -> None:
    value = ["pos", 1, [yarpy.Vocab("ok"), ["angle", 2.5]], b"\0\1", "<b>" * 20]
    trace, told = traced(value, value)
    assert told["rows"][0] == (0.0, 1, 2.5)
    assert [(one["index"], one["label"]) for one in told["curves"]] == [(1, "pos"), (4, "angle")]
    long = yarpy.Bottle(["<b>" * 20]).to_text()[:30]
    assert told["others"] == [
        "pos at 0", "[ok] at 2", "angle at 3", "2 bytes at 5", f"{long}... at 6",
    ]  # fmt: skip
    trace.take(message([0, 1]), 3.0)  # it was one after all
    assert "pos at 0" not in trace.told(0, 4.0)["others"]
    assert [curve["index"] for curve in trace.told(0, 4.0)["curves"]] == [1, 4, 0]


@pytest.mark.parametrize(
    ("value", "complaint"),
    [
        (["a", "b"], "no number in: a b"),
        ([], "no number in: "),
        (yarpy.Image(np.zeros((2, 2), "u1")), "an image, which `yarpy view` shows"),
        (yarpy.Sound(np.zeros((1, 2), "i2")), "a sound, which `yarpy hear` plays"),
        (b"\x01\x02\x03", "a message that cannot be read: "),
    ],
)
def test_messages_without_numbers(value: Any, complaint: str) -> None:
    payload = b"".join(map(bytes, value.to_wire())) if hasattr(value, "to_wire") else value
    _, told = traced(payload, [1])
    assert (told["empty"], told["total"]) == (1, 1)
    assert told["complaint"].startswith(complaint)


def test_chosen_indices() -> None:
    _, told = traced([10, 11, "x", 13], [20], ["y"], indices=(3, 0, 2))
    assert [curve["index"] for curve in told["curves"]] == [3, 0, 2]
    assert told["rows"] == [(0.0, 13, 10, None), (1.0, None, 20, None)]
    assert (told["empty"], told["complaint"]) == (1, "nothing at these indices in: y")
    assert traced([1, 2, 3], indices=(0,))[1]["more"] == 2


def test_a_few_of_many() -> None:
    _, told = traced(list(range(CURVES + 5)))
    assert len(told["curves"]) == CURVES
    assert told["more"] == 5
    _, told = traced(list(range(LEAVES + 100)), indices=(LEAVES - 1,))
    assert told["rows"] == [(0.0, LEAVES - 1)]


def test_messages_that_grow() -> None:
    _, told = traced([1], [2, 3], ["x", 4])
    assert told["rows"] == [(0.0, 1), (1.0, 2, 3), (2.0, None, 4)]


def test_only_what_is_new_and_not_too_much_at_once() -> None:
    trace = Trace("/x")
    for number in range(HISTORY + 500):
        trace.take(message([number]), number * 0.001)
    told = trace.told(HISTORY + 490, 20.5)
    assert [row[1] for row in told["rows"]] == list(range(HISTORY + 490, HISTORY + 500))
    assert told["next"] == told["total"] == HISTORY + 500
    found: list[float] = []
    after = 0
    while after < told["total"]:
        told = trace.told(after, 20.5)
        assert 0 < len(told["rows"]) <= AT_ONCE
        found += [row[1] for row in told["rows"]]
        after = told["next"]
    assert found == list(range(500, HISTORY + 500))
    assert trace.told(after, 20.5)["rows"] == []
    assert trace.told(after + 1, 20.5)["rows"][0][1] == 500  # of another run, it seems
    assert trace.told(after, 20.5 + MEMORY)["rate"] == 0.0


def test_stamps_place_what_comes_in_bursts() -> None:
    trace = Trace("/x")
    for number in range(4):
        trace.take(message([number], f"{number} {1000.0 + number * 0.1}"), 5.0 + number % 2 * 0.3)
    assert [row[0] for row in trace.told(0, 6.0)["rows"]] == pytest.approx([5.0, 5.1, 5.2, 5.3])


@pytest.mark.parametrize(
    ("arrivals", "stamps", "expected"),
    [
        ([1.0, 2.0, 3.0], [None, None, None], [1.0, 2.0, 3.0]),
        ([1.0, 2.0, 3.0], [50.0, 51.1, 51.9], [1.0, 2.1, 2.9]),
        ([1.0, 2.0, 3.0], [50.0, 20.0, 21.1], [1.0, 2.0, 3.1]),  # the clock was set
        ([1.0, 2.0, 3.0], [0.0, 0.1, 0.2], [1.0, 2.0, 3.0]),  # a slow simulation
        ([1.0, 2.0, 3.0], [math.nan, 5.0, math.inf], [1.0, 2.0, 3.0]),
        ([1.0, 1.1, 1.2], [5.0, 4.9, 5.0], [1.0, 1.0, 1.0]),  # never backwards
        ([1.0, 2.0, 2.1], [5.0, 6.0 + 2 * TRUST, 6.1], [1.0, 2.0, 2.1]),
    ],
)
def test_clock(arrivals: list[float], stamps: list[float | None], expected: list[float]) -> None:
    clock = Clock()
    found = [clock.place(*pair) for pair in zip(arrivals, stamps, strict=True)]
    assert found == pytest.approx(expected)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", []),
        ("0", [0]),
        ("0,2, 5", [0, 2, 5]),
        ("(0 1 2)", [0, 1, 2]),
        ("3-5,4,0", [3, 4, 5, 0]),
    ],
)
def test_indices(text: str, expected: list[int]) -> None:
    assert parse_indices(text) == expected


@pytest.mark.parametrize("text", ["x", "-1", "1-", "2-1", "1.5", "0-99999", f"{LEAVES}"])
def test_what_is_no_index(text: str) -> None:
    with pytest.raises(ValueError, match="ind"):
        parse_indices(text)


def test_leaves() -> None:
    assert list(flat([1, ("a", [2.5]), b"x", []])) == [1, "a", 2.5, b"x"]
    assert [number_of(leaf) for leaf in (1, 2.5, True, "1", b"", None)] == [
        1, 2.5, 1, None, None, None,
    ]  # fmt: skip


def test_times_of_measurements_are_no_curves() -> None:
    """As an inertial unit sends them; somebody may still choose them."""
    value = [[[[0.5, 1.5], 1795.25]], [[[9.8], 1795.25], [[8.8], 1795.25]], []]
    assert [index for index, (_, time) in enumerate(leaves_of(value)) if time] == [2, 4, 6]
    assert not any(time for _, time in leaves_of([[1.0, 2.0], 3.0]))
    assert list(flat(value)) == [0.5, 1.5, 1795.25, 9.8, 1795.25, 8.8, 1795.25]


def test_what_a_device_says_of_its_numbers() -> None:
    trace, told = traced(["a", 1.0, 2.0])
    assert [(one["label"], one["unit"]) for one in told["curves"]] == [("a", ""), ("", "")]
    trace.describe(lambda value: [("", ""), ("elbow", "°"), ("", "m")][: len(value)])
    trace.take(message(["a", 1.0, 2.0]), 1.0)
    told = trace.told(0, 1.0)
    assert [(one["label"], one["unit"]) for one in told["curves"]] == [("elbow", "°"), ("", "m")]


@pytest.mark.parametrize("labels", [[], [("x", "")] * 3, None])
def test_messages_other_than_a_device_said(labels: list[tuple[str, str]] | None) -> None:
    trace = Trace("/x")
    trace.describe(lambda value: labels[:] if labels is not None else value[7])
    trace.take(message([1.0, 2.0]), 0.0)
    told = trace.told(0, 1.0)
    assert [(one["label"], one["unit"]) for one in told["curves"]] == [("", "")] * 2
    assert told["total"] == 1
