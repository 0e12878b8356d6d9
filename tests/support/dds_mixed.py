"""A message with values of all kinds, for cyclonedds' Python to write: of types that stay as they
are, and of such to which a later version may add fields."""

# No annotations as text: cyclonedds looks at them.
from dataclasses import dataclass

from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import appendable, final
from cyclonedds.idl.types import array, float64, int16, int64, sequence, uint8


@dataclass
@final
class FinalInner(IdlStruct, typename="p.FinalInner"):
    a: uint8
    b: int64


@dataclass
@final
class FinalMixed(IdlStruct, typename="p.FinalMixed"):
    a: uint8
    b: float64
    c: str
    d: sequence[int16]
    e: sequence[float64]
    f: sequence[str]
    g: FinalInner
    h: sequence[FinalInner]
    i: array[FinalInner, 2]
    j: uint8


@dataclass
@appendable
class Inner(IdlStruct, typename="p.Inner"):
    a: uint8
    b: int64


@dataclass
@appendable
class Mixed(IdlStruct, typename="p.Mixed"):
    a: uint8
    b: float64
    c: str
    d: sequence[int16]
    e: sequence[float64]
    f: sequence[str]
    g: Inner
    h: sequence[Inner]
    i: array[Inner, 2]
    j: uint8


def mixed(extensible: bool) -> IdlStruct:
    """Return the one message that a test compares."""
    outer, inner = (Mixed, Inner) if extensible else (FinalMixed, FinalInner)
    pairs = [inner(a, a + 1) for a in (1, 3)]
    others = [inner(a, a + 1) for a in (5, 7)]
    return outer(1, 2.5, "three", [4, 5], [6.5, 7.5], ["a", "bc"], inner(8, 9), pairs, others, 10)
