"""Streamed commands, as sent to a command:i port: a head and a vector.

    ([vmo] 2) (10.5)                velocity_move of joint 2
    ([dpos]) (1.0 2.0 3.0)          position_direct of all joints
    ([dtqg] 2 (0 2)) (0.1 0.2)      apply_torques of some
    ([icur] [ref] 2) (0.5)          interfaces with a word of their own

    ([ivel] [vmo] 2) (10.5)         YARP 4 has one for each: ivel, ipod, itrq, ipos
    ([ived] [vdso] 2) (10.5)        velocity_direct, which only YARP 4 has

Rules: the vector holds only float64, one for each joint in the head, all finite. Anything else is
refused as a whole. (C++ reads past the end of vectors that are too short.)

Source: StreamingMessagesParser of controlBoard_nws_yarp, and what remote_controlboard sends.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.control_board.grammar import Form
from yarpy.kits.devices.kind import items, number, whole, word
from yarpy.kits.devices.refusal import Refused

#: Words of the head -> the method, and for how many joints.
HEADS: Final[dict[tuple[str, ...], tuple[str, Form]]] = {
    ("vmo",): ("velocity_move", Form.ONE),
    ("vmos",): ("velocity_move", Form.ALL),
    ("vmog",): ("velocity_move", Form.SOME),
    ("dpo",): ("position_direct", Form.ONE),
    ("dpos",): ("position_direct", Form.ALL),
    ("dpog",): ("position_direct", Form.SOME),
    ("dtq",): ("apply_torques", Form.ONE),
    ("dtqs",): ("apply_torques", Form.ALL),
    ("dtqg",): ("apply_torques", Form.SOME),
    ("icur", "ref"): ("apply_currents", Form.ONE),
    ("icur", "refs"): ("apply_currents", Form.ALL),
    ("icur", "refg"): ("apply_currents", Form.SOME),
    ("ipwm", "ref"): ("apply_duty_cycles", Form.ONE),
    ("ipwm", "refs"): ("apply_duty_cycles", Form.ALL),
    ("poss",): ("position_move", Form.ALL),
    ("ived", "vdso"): ("velocity_direct", Form.ONE),
    ("ived", "vdsa"): ("velocity_direct", Form.ALL),
    ("ived", "vdsg"): ("velocity_direct", Form.SOME),
}
#: what YARP 4 has in front of the words
_INTERFACES: Final = {
    "velocity_move": "ivel",
    "position_direct": "ipod",
    "apply_torques": "itrq",
    "position_move": "ipos",
}
_WORDS: Final = {found: words for words, found in HEADS.items()}
_NEWER: Final = {
    (method, form): (*([_INTERFACES[method]] if method in _INTERFACES else ()), *words)
    for words, (method, form) in HEADS.items()
}
_HEADS: Final = HEADS | {words: found for found, words in _NEWER.items()}


def read(message: object, count: int, exact: bool = True) -> tuple[str, list[int], list[float]]:
    """Method, joints and values of a message for `count` joints. Raises Refused.

    Not `exact`: integers are accepted too, for people who type.
    """
    head, body = items(message, 2)
    head, body = items(head), items(body)
    words = tuple(word(element) for element in head[:2])
    found = _HEADS.get(words[:1]) or _HEADS.get(words)
    if found is None:
        raise Refused(f"{Bottle(head).to_text()[:80]!r} is not a command")
    method, form = found
    rest = head[1:] if words[:1] in HEADS else head[2:]
    joints = _joints(form, rest, count)
    if len(body) != len(joints):
        raise Refused(f"{len(body)} values for {len(joints)} joints")
    if exact and not all(type(value) is float for value in body):
        raise Refused("the values are not all float64")
    return method, joints, [number(value) for value in body]


def make(
    method: str, joints: Sequence[int], values: Sequence[float], count: int, newer: bool = False
) -> list[Bottle]:
    """The messages for this command: a single one where the protocol has a word for it. `newer`:
    with the words of YARP 4."""
    words = _NEWER if newer else _WORDS

    def message(form: Form, rest: Sequence[Any], values: Sequence[float]) -> Bottle:
        head = Bottle([*map(Vocab, words[method, form]), *rest])
        return Bottle([head, Bottle(map(float, values))])

    if [*joints] == [*range(count)] and count > 1:
        return [message(Form.ALL, (), values)]
    if len(joints) > 1 and (method, Form.SOME) in words:
        return [message(Form.SOME, (len(joints), Bottle(joints)), values)]
    return [
        message(Form.ONE, (joint,), [value]) for joint, value in zip(joints, values, strict=True)
    ]


def _joints(form: Form, rest: Sequence[Any], count: int) -> list[int]:
    if form is Form.ALL:
        return [*range(count)]
    if not rest:
        raise Refused("the head names no joints")
    if form is Form.ONE:
        return [whole(rest[0])]
    listed = items(rest[1] if len(rest) > 1 else None, whole(rest[0]))
    return [whole(joint) for joint in listed]
