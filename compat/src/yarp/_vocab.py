"""Vocabs as numbers: `encode("set")`, `decode(7628147)`, `createVocab32("s", "e", "t")`."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._value import int32, text
from yarp._vocab64 import code64, word64


def createVocab32(a: Any, *more: Any) -> int:
    """The number of a word, or of its letters one by one."""
    return yarpy.Vocab("".join(map(text, (a, *more)))).code


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
    """The number of a word of up to eight letters, or of these one by one."""
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
