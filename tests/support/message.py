"""Random messages for property tests, and a Walker that is fed in pieces."""

from __future__ import annotations

from hypothesis import strategies as st

from yarpy.data.bottle import Bottle
from yarpy.data.value import Float32, Int8, Int16, Int64, Vocab
from yarpy.data.walker import Walker

texts = st.text(max_size=12) | st.binary(max_size=8).map(
    lambda raw: raw.decode("utf-8", "surrogateescape")
)
vocabs = st.text(st.characters(min_codepoint=33, max_codepoint=126), min_size=1, max_size=4).map(
    Vocab
)
ints = st.integers(-(2**63), 2**63 - 1)
floats = st.floats(allow_nan=False)

scalars = (
    ints
    | floats
    | texts
    | st.booleans()
    | vocabs.filter(lambda vocab: vocab.code != 0x31)
    | st.binary(max_size=12)
    | st.integers(-128, 127).map(Int8)
    | st.integers(-32768, 32767).map(Int16)
    | ints.map(Int64)
    | st.floats(width=32, allow_nan=False).map(Float32)
)

bottles = st.recursive(
    st.lists(scalars, max_size=5).map(Bottle),
    lambda inner: st.lists(scalars | inner, max_size=5).map(Bottle),
    max_leaves=20,
)


def kinds(value: object) -> object:
    """The exact types inside a value: what equality does not see."""
    if isinstance(value, list):
        return [kinds(item) for item in value]
    if type(value) is Int64 and not -(2**31) <= value < 2**31:
        return int  # needs 64 bits either way and comes back as a plain int
    return type(value)


def walk(message: bytes, step: int = 1, yarp4: bool = False) -> int:
    """Feed a Walker `step` more bytes at a time; the length it finds, -1 if it wants more."""
    walker = Walker(yarp4=yarp4)
    for size in range(0, len(message) + step, step):
        size = min(size, len(message))
        need = walker.advance(message[:size])
        if walker.done:
            return need
        assert need > size
    return -1
