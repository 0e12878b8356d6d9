"""The settings of the conformance suite: a carrier, the messages to try, and what must arrive.

Rules: no tests here, only settings that are not among a carrier's facts; the tests are in
`conformance_dialogue` and `conformance_live`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from yarpy.carriers.base import Carrier
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.testing.drive import Dialogue
from yarpy.wire.message import Message

ENVELOPE = "7 1.25"
SIZES = (0, 1, 100, 4095, 4096, 4097, 16384, 65535, 65536, 65537, 300_000)


class ConformanceCase:
    """A carrier under test; each attribute and method may be overridden.

    modifiers: appended to the carrier's name in connections, such as `+ack`.
    names_sender: the acceptor learns who dialled. carries_envelopes: envelopes arrive.
    values: messages to send; replace them if your carrier cannot carry all of these.
    timeout: seconds that a live connection may take.
    missing: why this computer cannot carry it, "" if it can: then nothing is tried live.
    """

    carrier: ClassVar[type[Carrier]]
    modifiers: ClassVar[str] = ""
    names_sender: ClassVar[bool] = True
    carries_envelopes: ClassVar[bool] = True
    values: ClassVar[Sequence[Any]] = (
        [],
        [1],
        [-1, 2**31 - 1, -(2**31), 2**40, 1.5, -0.0, 1e300],
        ["text", "", "two words", "\u00fc\u00f1\u00ee\u4f60", 'quo"te', "back\\slash"],
        [b"\0\1\xff", b""],
        [Vocab("set"), True, False],
        [[], [1, ["deep", [2.5]]], ["x", "y"]],
        {"key": 1, "group": {"inner": [1, 2]}},
        "a string",
        7,
        2.5,
    )
    sizes: ClassVar[Sequence[int]] = SIZES
    timeout: ClassVar[float] = 5.0
    missing: ClassVar[str] = ""

    # -- to override where a spelling loses something ---------------------------------------------

    def expected(self, value: Any) -> Any:
        """Return what the receiver of `value` gets."""
        if self.carrier.spelling == "text":
            return codec.decode_text(codec.encode_text(value))
        if self.carrier.spelling == "object":
            return value
        return codec.decode(_joined(value))

    def of_size(self, size: int) -> Any:
        """A message of about `size` bytes."""
        if self.carrier.spelling == "text":
            return ["x" * size]
        return [bytes(size)]

    # -- inside -----------------------------------------------------------------------------------

    def _greeted(self, piece: int = 0, modifiers: str | None = None) -> Dialogue:
        talk = Dialogue(
            self.carrier, self.modifiers if modifiers is None else modifiers, piece=piece
        )
        talk.greet()
        return talk

    def _check(self, message: Message, value: Any) -> None:
        wanted, got = self.expected(value), message.value
        same = got is wanted or _joined(got) == _joined(wanted)
        assert same, f"{value!r} arrived as {got!r}, not as {wanted!r}"

    def _acknowledge(self, talk: Dialogue) -> None:
        if self._acknowledges(talk):
            talk.acknowledge()

    def _acknowledges(self, talk: Dialogue) -> bool:
        """Return whether messages are acknowledged, and the sender waits for that."""
        (_, sending), (_, receiving) = talk.sender, talk.receiver
        return receiving is not None and receiving.acks and sending.acks


def _joined(value: Any) -> bytes:
    return b"".join(bytes(block) for block in codec.encode(value))
