"""What C++ YARP 3.9.1 was recorded to say as Thrift (tests/golden/thrift), and requests by hand."""

import json
from pathlib import Path
from typing import Any

from support.way_back import way_back

from yarpy.data import codec
from yarpy.wire.message import CALL, Message

GOLDEN = Path(__file__).parents[1] / "golden" / "thrift"


def rows(name: str) -> list[dict[str, str]]:
    found: list[dict[str, str]] = json.loads((GOLDEN / f"{name}.json").read_text())
    return found


CALLS = {row["name"]: row for row in rows("calls")}


def asked(data: bytes, spelling: Any = "binary", wants: bool = True) -> tuple[Message, list[Any]]:
    """A request, and what is answered to it."""
    answers: list[Any] = []
    message = Message(CALL, data, spelling=spelling)
    message.source = "/client"
    if wants:
        message.answer = way_back(answers.append)
    return message, answers


def reply(server: Any, data: bytes | str) -> Any:
    """The bytes of the answer, or its text."""
    if isinstance(data, bytes):
        message, answers = asked(data)
        found = server(message)
        return b"".join(codec.encode(answers[0] if answers else found))
    message, answers = asked(data.encode(), "text")
    found = server(message)
    return codec.encode_text(answers[0] if answers else found).decode()
