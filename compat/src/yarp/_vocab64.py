"""Words of up to eight letters as numbers, which YARP 4 has: `encode64("position")`.

Rules: in a Bottle it is a string that knows its number, and it is sent as that string: YARP 3 has
no such words, and what comes from YARP 4 is a string, too.
"""

from __future__ import annotations


def code64(word: str) -> int:
    """Return the number of a word; what follows its eighth letter is dropped."""
    letters = word.encode("latin-1", "replace")[:8]
    return int.from_bytes(letters.ljust(8, b"\0"), "little", signed=True)


def word64(code: int) -> str:
    """Return the word of a number."""
    letters = (code & 0xFFFFFFFFFFFFFFFF).to_bytes(8, "little")
    return letters.rstrip(b"\0").decode("latin-1")


class Word64(str):
    """A string that `isVocab64`."""

    __slots__ = ()
