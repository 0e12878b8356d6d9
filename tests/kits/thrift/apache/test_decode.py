"""The bytes of Apache's library to values."""

from typing import Any

import numpy as np
import pytest
from support.steps import measured
from support.thrift_module import SPELLINGS, apache, body, data, everything

from yarpy.errors import DecodeError
from yarpy.kits import thrift
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.apache import decode, encode
from yarpy.limit import THRIFT_ITEMS


def read(spelling: str, kind: Any, found: bytes) -> Any:
    return decode.get(decode.READERS[spelling](found), kind, "here")


def both(spelling: str, kind: Any, value: Any) -> Any:
    writer = encode.WRITERS[spelling]()
    encode.put(writer, kind, value, "here")
    return read(spelling, kind, bytes(writer.out))


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_every_kind_of_field(spelling: str) -> None:
    reader = decode.READERS[spelling](data("echo", spelling), body("echo", spelling))
    found = decode.fields(reader, {1: apache().All}, "echo")[1]
    assert found == everything() and reader.left == 0
    assert isinstance(found.i, np.ndarray) and found.l is apache().Mode.MANUAL
    assert (found.r, found.p.side, found.n[0].note) == (None, None, None)


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_what_is_not_known_is_left_out(spelling: str) -> None:
    class Small(thrift.Struct):
        _numbers = (5, 9, 99)
        e: thrift.i64 = 0
        i: str = "another type"
        z: thrift.i32 = 3

    found = read(spelling, Small, data("echo", spelling)[body("echo", spelling) :])
    assert found == Small(0)  # the one field there is a struct
    all_ = encode.WRITERS[spelling]()
    encode.put(all_, apache().All, everything(), "all")
    found = read(spelling, Small, bytes(all_.out))
    assert (found.e, found.i, found.z) == (-(1 << 50), "another type", 3)


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_a_required_field_is_missed(spelling: str) -> None:
    with pytest.raises(DecodeError, match="here: t is required, and not there"):
        read(spelling, apache().All, b"\0")


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_unsigned_numbers_and_words(spelling: str) -> None:
    assert both(spelling, kinds.UI64, (1 << 64) - 1) == (1 << 64) - 1
    assert both(spelling, kinds.ListOf(kinds.UI16), [65535, 1]).tolist() == [65535, 1]
    assert both(spelling, kinds.ListOf(kinds.FLOAT), [0.5]).dtype == np.float32
    assert both(spelling, kinds.VOCAB, "abc") == "abc"
    assert both(spelling, apache().Mode, 5) == 5


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_keys_and_elements_of_sets_can_be_anything(spelling: str) -> None:
    inner = apache().Inner
    kind = kinds.MapOf(inner, kinds.SetOf(kinds.ListOf(kinds.I32)))
    value = {inner(1): {(1, 2), (3,)}, inner(2, "b"): set()}
    assert both(spelling, kind, value) == value
    deeper = kinds.MapOf(kinds.MapOf(kinds.I32, kinds.ListOf(kinds.TEXT)), kinds.BOOL)
    key = thrift.frozen({1: ["a"]})
    assert both(spelling, deeper, {key: True}) == {key: True}


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_elements_of_another_type(spelling: str) -> None:
    for kind, other in (
        (kinds.ListOf(kinds.I32), kinds.ListOf(kinds.TEXT)),
        (kinds.SetOf(kinds.TEXT), kinds.SetOf(kinds.I32)),
    ):
        writer = encode.WRITERS[spelling]()
        encode.put(writer, other, {1} if kind == kinds.SetOf(kinds.TEXT) else ["a"], "here")
        with pytest.raises(DecodeError, match="other elements"):
            read(spelling, kind, bytes(writer.out))
    writer = encode.WRITERS[spelling]()
    encode.put(writer, kinds.MapOf(kinds.I32, kinds.I32), {1: 1}, "here")
    with pytest.raises(DecodeError, match="other keys or values"):
        read(spelling, kinds.MapOf(kinds.I32, kinds.TEXT), bytes(writer.out))


@pytest.mark.parametrize(
    ("spelling", "start", "inner"),
    [
        ("binary", "0c 7fffffff", 1),
        ("compact", "fc ffffffff07", 1),
        ("compact", "f7 ffffffff07", 8),
    ],
)
def test_nothing_is_taken_on_a_count(spelling: str, start: str, inner: int) -> None:
    kind = kinds.ListOf(apache().Inner if inner == 1 else kinds.DOUBLE)
    with measured() as peak, pytest.raises(DecodeError, match="elements are announced"):
        read(spelling, kind, bytes.fromhex(start) + bytes(1000))
    assert peak.bytes < 100_000


def test_small_structs_are_counted_by_their_fields() -> None:
    count = THRIFT_ITEMS // 24  # of fields that are not there: a byte each
    found = b"\x0c" + count.to_bytes(4, "big") + bytes(count)

    class Wide(thrift.Struct):
        pass

    hints = {f"f{at}": int for at in range(30)}
    wide = type("Wide", (thrift.Struct,), {"__annotations__": hints})
    with pytest.raises(DecodeError, match=f"more than {THRIFT_ITEMS} values"):
        read("binary", kinds.ListOf(wide), found)
    assert len(read("binary", kinds.ListOf(Wide), found)) == count


def test_endless_structs_are_refused() -> None:
    class Node(thrift.Struct):
        next: "Node | None" = None

    Node._namespace = {"Node": Node}
    with pytest.raises(DecodeError, match="nested more than"):
        read("binary", Node, bytes.fromhex("0c0001") * 70 + bytes(71))
    found = read("binary", Node, bytes.fromhex("0c0001") * 3 + bytes(4))
    assert found.next.next.next == Node()
