"""What devices of newer YARP say instead of ok, and how each version spells it.

    3.10    [ok]         3.12    0, or a number       4.0    ([ok]), or another vocab: ([err5])

Rules: a status stands in front of every answer of a function. Here it is that of 4.0; `older` makes
that of 3.12 of it. (3.11 has one without a tag, which nobody can read who does not know it.)
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import pack, unpack_from
from typing import Any, Final

from yarpy.data.value import LIST, VOCAB32, Buffer, Vocab

OK: Final = "ok"
MISSING: Final = "err2"
FAILED: Final = "err5"

#: the numbers of 3.12
_NUMBERS: Final = {
    "ok": 0,
    "err1": 1,
    "err2": 2,
    "err3": 3,
    "err4": 4,
    "err5": 5,
    "err6": 6,
    "err7": 1,
    "miss": 100,
}
_REASONS: Final = {
    "err1": "it failed",
    "err2": "it cannot do this",
    "err3": "it does not reach the device",
    "err4": "it does not do this any more",
    "err5": "it cannot do this, or not with these values",
    "err6": "it is not ready yet",
    "err7": "a value is out of bounds",
    "miss": "it says nothing",
    "fail": "it cannot do this, or not with these values",
}


def reason(code: str) -> str:
    """What a status that is not ok means."""
    return _REASONS.get(str(code), f"it says {code}")


def split(answer: Sequence[Any]) -> tuple[str, list[Any]]:
    """The status of an answer of any version, and what is behind it."""
    if not answer:
        return OK, []
    first = answer[0]
    if isinstance(first, (list, tuple)) and len(first) == 1:
        first = first[0]
    if isinstance(first, int) and not isinstance(first, bool):
        code = next((code for code, number in _NUMBERS.items() if number == first), "err1")
    else:
        code = str.__str__(first) if isinstance(first, str) else "fail"
    return code, [*answer[1:]]


def older(answer: Buffer) -> Buffer:
    """An answer with the status as YARP 3.12 has it."""
    data = bytes(answer)
    if len(data) >= 24 and unpack_from("<iiiii", data)[2:] == (LIST, 1, VOCAB32):
        number = _NUMBERS.get(str(Vocab.from_code(unpack_from("<i", data, 20)[0])), 1)
        return data[:8] + pack("<ii", 1, number) + data[24:]
    if len(data) == 16 and unpack_from("<iii", data) == (LIST, 1, VOCAB32):
        known = _NUMBERS.get(str(Vocab.from_code(unpack_from("<i", data, 12)[0])))
        return data if known is None else pack("<ii", 1, known)
    return data
