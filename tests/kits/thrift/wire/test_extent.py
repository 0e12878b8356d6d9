"""Where answers end that are no Bottles, byte by byte."""

from types import ModuleType
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.thrift import CALLS

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import ListOf, MapOf
from yarpy.kits.thrift.wire.extent import Extent, ending_of, version_ending, yarp4_ending_of

FAILED = bytes.fromhex("09010000010000006661696c")


def end(extent: Any, data: bytes) -> int:
    """Where it ends, from growing buffers that are followed by something else."""
    stream, size, need = data + b"YA\0\0\0\0RP" * 4, 0, 0
    while not extent.done:
        assert need <= len(data)
        size = max(need, size + 1)
        buffer = bytearray(stream[:size])
        need = extent.advance(memoryview(buffer))
        buffer += b"more"  # nobody may hold it
    return int(need)


@pytest.mark.parametrize("name", ["r_llist", "r_nest"])
def test_recorded_answers(name: str, capt: ModuleType) -> None:
    ending = capt.Capt._methods[name].ending
    answer = bytes.fromhex(CALLS[f"tcp_{name}"]["reply"])
    assert ending is not None and end(ending(1 << 20), answer) == len(answer)
    assert end(ending(1 << 20), FAILED) == len(FAILED)
    reason = Bottle(["fail", "why"]).to_bytes()
    assert end(ending(1 << 20), reason) == len(reason)


def test_answers_of_yarp_4() -> None:
    """A float32 has the tag of a float64 there; an acknowledgement follows at once."""
    one = "00010000 01000000"
    narrow = ListOf(ListOf(kinds.FLOAT))
    for kind, data in {
        kinds.FLOAT: f"{one} 0a000000 00005040",
        ListOf(kinds.FLOAT): f"{one} 0a010000 02000000 00005040 00005040",
        narrow: f"{one} 0a010000 02000000 0a010000 01000000 00005040 0a010000 00000000",
    }.items():
        ending, answer = yarp4_ending_of(kind), bytes.fromhex(data)
        assert ending is not None and end(ending(1 << 20), answer) == len(answer)
        assert end(ending(1 << 20), FAILED) == len(FAILED)
    wide = bytes.fromhex(f"{one} 14010000 01000000 14010000 01000000 0000000000000a40")
    for ending in (ending_of, yarp4_ending_of):
        found = ending(ListOf(ListOf(kinds.DOUBLE)))
        assert found is not None and end(found(1 << 20), wide) == len(wide)
    assert yarp4_ending_of(kinds.DOUBLE) is None and yarp4_ending_of(None) is None


def test_versions() -> None:
    version = bytes.fromhex("00010000010000000000 0300 0c00 0000")
    assert end(version_ending(1000), version) == 16
    assert end(version_ending(1000), FAILED) == 12


def test_one_string_is_no_version() -> None:
    text = bytes.fromhex("00010000 01000000 04000000 07000000 6e6f2069646561")
    assert end(version_ending(1000), text) == len(text)
    nested = bytes.fromhex("00010000 01000000 01010000 02000000 01000000 02000000")
    assert end(version_ending(1000), nested) == len(nested)


def test_who_needs_it(capt: ModuleType) -> None:
    assert ending_of(None) is None and ending_of(capt.Point) is None
    assert ending_of(ListOf(capt.Point)) is None and ending_of(ListOf(ListOf(capt.Point))) is None
    assert ending_of(MapOf(kinds.I32, ListOf(ListOf(kinds.I32)))) is not None
    assert ending_of(ListOf(capt.Nest)) is not None


@settings(max_examples=200)
@given(st.lists(st.lists(st.lists(st.text(max_size=3), max_size=3), max_size=3), max_size=3))
def test_any_depth(items: Any) -> None:
    from yarpy.kits.thrift.kind import Part
    from yarpy.kits.thrift.wire.fast_writer import dump

    kind = ListOf(ListOf(ListOf(kinds.TEXT)))
    data = dump("v", [Part("", kind)], b"\0\1\0\0\1\0\0\0")(items)
    assert end(Extent(kind, 1 << 20), data) == len(data)


@settings(max_examples=300)
@given(st.binary(max_size=60))
def test_rubbish_is_refused_or_has_an_end(capt: ModuleType, data: bytes) -> None:
    extent = Extent(capt.Nest, 1000)
    try:
        need = extent.advance(b"\0\1\0\0\6\0\0\0" + data)
    except DecodeError:
        return
    assert 0 <= need <= 1000 + 8
