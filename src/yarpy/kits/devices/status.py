"""Return values of devices of newer YARP, which stand for ok, as each version spells them.

    3.10    [ok]         3.12    0, or a number       4.0    ([ok]), or another vocab: ([err5])

Rules: a status stands in front of every answer of a function. Here it is that of 4.0; `older` makes
that of 3.12 of it, `oldest` that of 3.10, and `newest` makes it of either. (3.11 has one without a
tag, which nobody can read who does not know it.)
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import pack, unpack_from
from typing import Any, Final

from yarpy.data.value import INT32, LIST, VOCAB32, Buffer, Vocab, vocab_code

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
    """Return the meaning of a status that is not ok."""
    return _REASONS.get(str(code), f"it says {code}")


def split(answer: Sequence[Any]) -> tuple[str, list[Any]]:
    """The status of an answer of any version, and what is behind it."""
    if not answer:
        return OK, []
    first = answer[0]
    if isinstance(first, (list, tuple)) and len(first) == 1:
        first = first[0]
    if isinstance(first, int) and not isinstance(first, bool):
        code = _code(first)
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


def oldest(answer: Buffer) -> Buffer:
    """An answer with the status as YARP 3.10 and earlier have it: true or false."""
    data = bytes(answer)
    if len(data) >= 24 and unpack_from("<iiiii", data)[2:] == (LIST, 1, VOCAB32):
        return data[:8] + _flag(data, 20) + data[24:]
    if len(data) == 16 and unpack_from("<iii", data) == (LIST, 1, VOCAB32):
        return data[:8] + _flag(data, 12)
    return data


def newest(answer: Buffer, boxed: bool) -> Buffer:
    """An answer of any version with the status as YARP 4.0 has it. `boxed`: it stands in a list of
    its own, as it does where results follow."""
    data = bytes(answer)
    if len(data) == 8:  # 3.12, without results
        tag, number = unpack_from("<ii", data)
        words = _words(_code(number)) if tag == INT32 else b""
        return pack("<ii", LIST, 1) + (pack("<ii", LIST, 1) if boxed else b"") + words
    if len(data) < 12:
        return data
    tag, count, first = unpack_from("<iii", data)
    if tag == LIST + VOCAB32:  # nothing but flags
        flags = [data[at : at + 4] for at in range(8, len(data) - 3, 4)]
        data = pack("<ii", LIST, count) + b"".join(pack("<i", VOCAB32) + each for each in flags)
        first = VOCAB32
    if tag not in (LIST, LIST + VOCAB32) or len(data) < 16:
        return data
    if first == LIST + VOCAB32 and len(data) >= 20:
        return data[:8] + pack("<iii", LIST, 1, VOCAB32) + data[16:]
    if first == VOCAB32 and (boxed or count > 1):
        code = "ok" if unpack_from("<i", data, 12)[0] not in (0, _FAIL) else "fail"
        return data[:8] + pack("<ii", LIST, 1) + _words(code) + data[16:]
    if first == INT32 and boxed:
        code = _code(unpack_from("<i", data, 12)[0])
        return data[:8] + pack("<ii", LIST, 1) + _words(code) + data[16:]
    return data


def _flag(data: bytes, at: int) -> bytes:
    is_ok = unpack_from("<i", data, at)[0] == vocab_code(b"ok")
    return _words(OK if is_ok else "fail")


def _words(code: str) -> bytes:
    return pack("<ii", VOCAB32, vocab_code(code.encode()))


def _code(number: int) -> str:
    return next((code for code, known in _NUMBERS.items() if known == number), "err1")


_FAIL: Final = vocab_code(b"fail")
