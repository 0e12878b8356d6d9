"""Values of any ROS type, made by chance: limits of every kind of number, text of every kind."""

from collections.abc import Sequence
from random import Random
from typing import Any

import numpy as np

from yarpy.peers.ros.message.message import Duration, Message, Time
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

PLAIN = ("", "base", "grüße", "two words", "x" * 300, '"quoted" (1 2)', "3")
#: and bytes that are no text, which rospy replaces
TEXTS = (*PLAIN, "\udcff\udc80")


def filled(cls: type[Message], chance: Random, texts: Sequence[str] = TEXTS) -> Any:
    """A message of a class with something in every field; strings are some of `texts`."""
    fields = cls._definition.struct.fields
    return cls(
        **{
            name: _value(cls, field.type, chance, texts)
            for name, field in zip(cls._names, fields, strict=True)
        }
    )


def _value(cls: type[Message], kind: Type, chance: Random, texts: Sequence[str]) -> Any:
    if isinstance(kind, Struct):
        return filled(cls._used[kind], chance, texts)
    if isinstance(kind, ListOf):
        most = 7 if kind.most is None else kind.most
        length = kind.length
        if length is None:
            length = chance.choice([count for count in (0, 1, 2, 7) if count <= most])
        values = [_value(cls, kind.element, chance, texts) for _ in range(length)]
        if isinstance(kind.element, Primitive) and kind.element.is_number:
            return np.array(values, "<" + kind.element.letters)
        return values
    assert isinstance(kind, Primitive)
    if kind.name == "string":
        return chance.choice(texts)
    if kind.name == "time":
        return Time(chance.getrandbits(32), chance.randrange(1_000_000_000))
    if kind.name == "duration":
        return Duration(chance.getrandbits(32) - (1 << 31), chance.randrange(1_000_000_000))
    if kind.name == "bool":
        return bool(chance.getrandbits(1))
    if kind.letters in "fd":
        return float(np.float32(chance.choice((0.0, -1.5, chance.random(), 1e30, float("inf")))))
    bits = 8 * kind.size
    value = chance.choice((0, (1 << bits) - 1, 1 << (bits - 1), chance.getrandbits(bits)))
    return value if kind.letters.isupper() else value - (1 << (bits - 1))
