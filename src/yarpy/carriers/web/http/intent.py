"""A request over HTTP as values: what it asks for (a message, a command), or why it is refused.

Rules: pure values. `request.py` reads a request into an Intent or a Refusal; `response.py` answers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal, Protocol, TypeAlias

from yarpy.carriers.web.http.message import TEXT
from yarpy.carriers.web.http.origin import QUESTIONS
from yarpy.data.json import Outer
from yarpy.wire.effects import HEAR
from yarpy.wire.message import ADMIN, CALL, DATA, JSON, Message, Spelling

Form: TypeAlias = Literal["page", "json", "text", "none", "events", "reply_page"]

READS: Final = ("*", "?", "h", "r")  # port commands that change nothing
# What requests need of who makes them; `administer` for all others. Whether an administrative
# message asks or changes something, the port judges.
_RIGHTS: Final = {
    **dict.fromkeys(("*", "?", "h", ADMIN), "ask"),
    "r": HEAR,
    CALL: "write",
    DATA: "write",
}

_FIRST: Final = 40  # bytes among which the first word of a question is


@dataclass(frozen=True, slots=True)
class Request:
    """A request with its body; header names in lower case."""

    method: str
    target: str
    headers: Mapping[str, str]
    body: bytes = b""


class Content(Protocol):
    """The body of a POST as a plug-in of `yarpy.contents` reads it, which is called with it;
    DecodeError for one that it cannot read."""

    kind: str
    message: Message

    def reply(self, value: object) -> bytes:
        """Return the body of the answer to what the port replies; None: to no reply."""


@dataclass(frozen=True, slots=True)
class Intent:
    """A message or port command (`key`, as in Message), and how to answer it.

    shown: the text to keep in the page's form. pixels: the reader wants whole pictures. rate: the
    most messages per second that it wants; 0: all. content: what reads the body and writes the
    answer, of a kind that this carrier does not know. acts: it may change something. asks: it does
    not, by its first word.
    """

    key: str
    form: Form
    payload: bytes = b""
    spelling: Spelling = "text"
    text: str = ""
    outer: Outer = "auto"
    shown: str = ""
    pixels: bool = False
    rate: float = 0.0
    content: Content | None = None

    @property
    def acts(self) -> bool:
        return self.key not in READS

    @property
    def asks(self) -> bool:
        first, _, _ = self.payload[:_FIRST].lstrip().partition(b" ")
        text = self.spelling == "text" and self.key == CALL
        return text and first.strip().decode("latin-1") in QUESTIONS

    @property
    def right(self) -> str:
        """Return the right that the request needs (`link/begin/admission.py`)."""
        return _RIGHTS.get(self.key, "administer")

    def message(self, envelope: str = "") -> Message:
        """The message for the port."""
        if self.content is not None:
            return self.content.message
        text = self.text
        if self.form == "json" and self.key in (DATA, CALL):
            text = JSON  # makes a name service answer with values
        return Message(self.key, self.payload, envelope, self.spelling, text)


@dataclass(frozen=True, slots=True)
class Refusal:
    """An answer that does not involve the port; a `status` below 400 is not an error."""

    status: int
    text: str = ""
    kind: str = TEXT
