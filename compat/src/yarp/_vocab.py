"""Vocabs as numbers: `encode("set")`, `decode(7628147)`, `createVocab32("s", "e", "t")`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import yarpy
from yarp._value import int32, text
from yarp._vocab64 import code64, word64


def createVocab32(a: Any, *more: Any) -> int:
    """The number of a word, or of its letters one by one; a letter may be its number."""
    if any(isinstance(each, int) for each in (a, *more)):
        return _spelled((a, *more), 32)
    return yarpy.Vocab("".join(map(text, (a, *more)))).code


def _spelled(letters: Sequence[Any], bits: int) -> int:
    """The number of letters, which may be numbers themselves; in so many bits, as in C++."""
    found = sum(_letter(each) << 8 * at for at, each in enumerate(letters)) & (1 << bits) - 1
    return found - (found >> bits - 1 << bits)


def _letter(value: Any) -> int:
    if isinstance(value, int) and -128 <= value <= 127:
        return value
    if isinstance(value, str) and len(value) < 2 and value.isascii():
        return ord(value) if value else 0
    raise TypeError(f"a letter, or a number from -128 to 127, is needed, not {value!r}")


def createVocab(a: Any, *more: Any) -> int:
    """The number of a word, or of its letters one by one."""
    return createVocab32(a, *more)


def VOCAB(a: Any, *more: Any) -> int:
    """The number of a word, or of its letters one by one."""
    return createVocab32(a, *more)


VOCAB1 = VOCAB2 = VOCAB3 = VOCAB4 = VOCAB


def encode(str: str) -> int:
    """The number of a word."""
    return createVocab32(str)


def decode(code: int) -> str:
    """The word of a number."""
    return str(yarpy.Vocab.from_code(int32(code)))


def createVocab64(a: Any, *more: Any) -> int:
    """The number of a word of up to eight letters, or of these one by one, as above."""
    if any(isinstance(each, int) for each in (a, *more)):
        return _spelled((a, *more), 64)
    return code64("".join(map(text, (a, *more))))


def encode64(str: str) -> int:
    """The number of a word of up to eight letters."""
    return createVocab64(str)


def decode64(code: int) -> str:
    """The word of such a number."""
    return word64(code)


class Vocab:
    """The same two under the names of older versions: `Vocab.encode`, `Vocab_encode`."""

    encode = staticmethod(encode)
    decode = staticmethod(decode)
