"""The message of stateExt:o: eleven measurements of all joints, each with a flag.

    (positions) [ok] (speeds) [ok] ... (control modes) [ok] (interaction modes) [fail]

Programs of YARP 4 have the motors' temperatures behind these, and these and the duty cycles are
float32.

Rules: always 22 elements, or 24, and always as many values as joints: C++ clients copy them
blindly, and drop a message that contains an empty list. Missing measurements are zeros and
`[fail]`. Numbers are float64, modes int32 (the vocab code of the word).

Source: the struct that controlBoard_nws_yarp sends, YARP 2.3.70 to 3.12, and 4.0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from struct import pack
from typing import Any, Final

from yarpy.data.value import FLOAT32, FLOAT64, INT32, LIST, VOCAB32, Vocab
from yarpy.errors import DecodeError
from yarpy.kits.devices.kind import FLOAT, WORD, Kind
from yarpy.kits.devices.refusal import Refused

#: What the message holds, in order.
FIELDS: Final[tuple[tuple[str, Kind], ...]] = (
    ("encoders", FLOAT),
    ("encoder_speeds", FLOAT),
    ("encoder_accelerations", FLOAT),
    ("motor_encoders", FLOAT),
    ("motor_speeds", FLOAT),
    ("motor_accelerations", FLOAT),
    ("torques", FLOAT),
    ("duty_cycles", FLOAT),
    ("currents", FLOAT),
    ("control_modes", WORD),
    ("interaction_modes", WORD),
)
#: What YARP 4 has behind these.
NEWER: Final = (*FIELDS, ("motor_temperatures", FLOAT))
#: What it sends as float32.
_SHORT: Final = frozenset(("duty_cycles", "motor_temperatures"))

_VALID: Final = Vocab("ok")
_INVALID: Final = Vocab("fail")
# Stands in for an unknown mode, to keep the length of the list.
_BLANK: Final = "unkw"


@dataclass(frozen=True, slots=True)
class State:
    """Measurements by name; those missing were not valid."""

    count: int
    values: dict[str, list[Any]]

    @classmethod
    def of(cls, count: int, ask: Callable[[str, Kind], list[Any]], newer: bool = False) -> State:
        """Ask for each field, `newer`: of YARP 4; refused ones are missing."""
        values: dict[str, list[Any]] = {}
        for name, kind in NEWER if newer else FIELDS:
            try:
                values[name] = ask(name, kind)
            except Refused:
                continue
        return cls(count, values)

    def to_bytes(self, newer: bool = False) -> bytes:
        """The 22 elements of a message, or the 24 of YARP 4, which still has them to be spelled as
        it does (`to_yarp4`)."""
        fields = NEWER if newer else FIELDS
        count, parts = self.count, [pack("<ii", LIST, 2 * len(fields))]
        for name, kind in fields:
            values = self.values.get(name)
            if kind is WORD:
                numbers: Iterable[float] = map(_code, values or [_BLANK] * count)
                tag, form = INT32, "i"
            else:
                short = newer and name in _SHORT
                tag, form = (FLOAT32, "f") if short else (FLOAT64, "d")
                numbers = values or [0.0] * count
            parts.append(pack(f"<ii{count}{form}", LIST + tag, count, *numbers))
            parts.append(pack("<ii", VOCAB32, (_INVALID if values is None else _VALID).code))
        return b"".join(parts)

    @classmethod
    def from_bottle(cls, message: Sequence[Any]) -> State:
        """Read the 22 or 24 elements; DecodeError if they are not a state."""
        if len(message) not in (2 * len(FIELDS), 2 * len(NEWER)):
            raise DecodeError(
                f"a state has {2 * len(FIELDS)} elements, or {2 * len(NEWER)}, this one "
                f"{len(message)}"
            )
        values: dict[str, list[Any]] = {}
        count = len(message[0]) if isinstance(message[0], (list, tuple)) else 0
        for index, (name, kind) in enumerate(NEWER[: len(message) // 2]):
            found, flag = message[2 * index], message[2 * index + 1]
            if not isinstance(found, (list, tuple)) or len(found) != count or not count:
                raise DecodeError(f"a state of {count} joints needs as many {name}")
            if flag in (0, "fail", False):
                continue
            read = _mode if kind is WORD else _number
            values[name] = [read(element) for element in found]
        return cls(count, values)


@lru_cache(200)
def _code(mode: str) -> int:
    """Return the number of a mode."""
    return Vocab(mode).code


def _number(element: object) -> float:
    if isinstance(element, (int, float)) and not isinstance(element, bool):
        return float(element)
    raise DecodeError(f"a state with {element!r} where a number belongs")


def _mode(element: object) -> str:
    """A mode: the code of its word, or the word itself, which senders of plain Bottles may use."""
    if isinstance(element, Vocab):
        return str.__str__(element)
    if type(element) is int and -0x80000000 <= element <= 0x7FFFFFFF:
        return str.__str__(Vocab.from_code(element))
    raise DecodeError(f"a state with {element!r} where a mode belongs")
