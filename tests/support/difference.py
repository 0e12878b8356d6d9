"""Where we answer C++ YARP 3.9.1 differently on purpose: capture, step, our answer, the reason.

Rules: the step is the one that asks (role a); our answer is bytes, or a check of them. Everything
that is not listed here has to be equal, byte for byte. What cannot be replayed at all is in
`NOT_REPLAYED`, with its reason; a test sees to it that no capture is in neither place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.data.walker import Walker
from yarpy.wire.framing import ACK

Check = Callable[[bytes], None]


@dataclass(frozen=True)
class Difference:
    """`ours` instead of what C++ answered to one step, or instead of its silence."""

    ours: bytes | Check
    reason: str


def payload(*elements: object) -> bytes:
    return Bottle(elements).to_bytes()


def refusal(then: bytes = b"") -> Check:
    """`[fail] "why"` and an acknowledgement, followed by `then`."""

    def check(data: bytes) -> None:
        walker = Walker()
        end = walker.advance(data)
        assert walker.done, data
        reply = Bottle.from_bytes(data[:end])
        assert reply[0] == Vocab("fail"), reply
        assert isinstance(reply[1], str), reply
        assert len(reply[1]) > 10, reply
        assert data[end:] == ACK + then

    return check


def reply_line(*lines: str) -> bytes:
    return "".join(f"{line}\r\n" for line in lines).encode()


ECHO_5 = payload(Vocab("ok"), "echo", [5]) + ACK
HANGS = "C++ acknowledges without a reply, for which its own clients wait for ever: we say why"
OUT_OF_STEP = "C++ loses step and understands nothing more; we skip exactly what was announced"
LINE_END = (
    "C++ ends the text of sig objects with a bare LF, that of Bottles with CR LF; we always CR LF"
)
SOUND = "C++ prints a Sound, which is no Bottle, as an empty line ended by LF; we by CR LF"

# Common to replays with bytes alone and to those against a real port.
DIFFERENT: dict[str, dict[int, Difference]] = {
    "bad_bottle_code": {
        2: Difference(refusal(), HANGS),
        4: Difference(ECHO_5, OUT_OF_STEP),
    },
    "bad_item_code": {
        2: Difference(refusal(), HANGS),
        4: Difference(ECHO_5, OUT_OF_STEP),
    },
    "bad_port_command": {2: Difference(ECHO_5, OUT_OF_STEP)},
    "bottle_count_too_big": {
        2: Difference(
            refusal(ECHO_5),
            "C++ takes the missing numbers from the next message; we refuse the short one and "
            "answer the next",
        )
    },
    "bottle_nested_special": {4: Difference(refusal(), HANGS)},
    "unknown_port_command": {4: Difference(ECHO_5, OUT_OF_STEP)},
    "conn_text_ack_sig_replies": {
        2: Difference(b"0.5 1.5 2.5\r\n<ACK>\r\n", LINE_END),
        4: Difference(b"2 3 (0.0 1.0 2.0 10.0 11.0 12.0)\r\n<ACK>\r\n", LINE_END),
        6: Difference(b"[mat] [mono] (1 6 1 3 2) {0 10 20 1 11 21}\r\n<ACK>\r\n", LINE_END),
        8: Difference(b"\r\n<ACK>\r\n", SOUND),
    },
}
