"""Values to the bytes that Apache's library writes."""

from typing import Any

import numpy as np
import pytest
from support.thrift_module import SPELLINGS, apache, body, data, everything

from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.apache import encode


def written(spelling: str, kind: Any, value: Any) -> bytes:
    writer = encode.WRITERS[spelling]()
    encode.put(writer, kind, value, "here")
    return bytes(writer.out)


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_kind_of_field(spelling: str) -> None:
    writer = encode.WRITERS[spelling]()
    encode.fields(writer, [(1, apache().All, everything(), "all")])
    # Apache's library was told the same fields in the same order.
    assert bytes(writer.out) == data("echo", spelling)[body("echo", spelling) :]


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_arrays_as_lists(spelling: str) -> None:
    for kind, letter in ((kinds.I16, "i2"), (kinds.I64, "i8"), (kinds.DOUBLE, "f8")):
        many = list(range(40))
        listed = kinds.ListOf(kind)
        found = written(spelling, listed, np.array(many, letter))
        assert found == written(spelling, listed, many)
    flags = kinds.ListOf(kinds.BOOL)
    assert written(spelling, flags, np.array([True, False])) == written(spelling, flags, [1, 0])


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_unsigned_numbers_keep_their_bits(spelling: str) -> None:
    assert written(spelling, kinds.UI8, 255) == written(spelling, kinds.I8, -1)
    assert written(spelling, kinds.UI32, 1 << 31) == written(spelling, kinds.I32, -(1 << 31))
    bytes_ = kinds.ListOf(kinds.UI8)
    assert written(spelling, bytes_, np.array([255], "u1")) == written(spelling, bytes_, [255])
    assert written(spelling, kinds.VOCAB, "ab") == written(spelling, kinds.I32, 0x6261)
    assert written(spelling, kinds.FLOAT, 0.5) == written(spelling, kinds.DOUBLE, 0.5)


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda m: m.All(d=1 << 40), "all.d: 1099511627776 does not fit in i32"),
        (lambda m: m.All(d=1.5), "all.d: expected an integer, got 1.5"),
        (lambda m: m.All(a=3), "all.a: expected True or False, got 3"),
        (lambda m: m.All(t=None), "all.t is required, and None"),
        (lambda m: m.All(l="AUTO"), "all.l: expected Mode.NAME"),
        (lambda m: m.All(l=1 << 40), "all.l: .* does not fit in i32"),
        (lambda m: m.All(m=5), "all.m: expected an Inner, got 5"),
        (lambda m: m.All(k=[1]), "all.k: expected a dict"),
        (lambda m: m.All(i=[1, "x"]), r"all.i\[1\]: expected an integer, got 'x'"),
        (lambda m: m.All(p=m.Shape()), "all.p: one field of a union is set, here none"),
        (lambda m: m.All(p=m.Shape(1, 2.0)), "here all.p.side, all.p.radius"),
    ],
)
def test_what_does_not_fit_is_named(spelling: str, make: Any, error: str) -> None:
    value = make(apache())
    if value.p is None or (value.p.side is None and "union" not in error):
        value.p = apache().Shape(1)
    with pytest.raises((TypeError, OverflowError), match=error):
        encode.put(encode.WRITERS[spelling](), apache().All, value, "all")


def test_levels_have_a_limit() -> None:
    kind: Any = kinds.I32
    value: Any = 1
    for _ in range(70):
        kind, value = kinds.ListOf(kind), [value]
    with pytest.raises(TypeError, match="more than 64 levels"):
        written("binary", kind, value)
