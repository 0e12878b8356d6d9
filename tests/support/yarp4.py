"""What C++ YARP 4.0.0 was recorded to say (tests/golden/yarp4_*.json)."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import yarpy
from yarpy.port.answer import admin
from yarpy.wire.message import CALL, Encoded, Message

_FOLDER = Path(__file__).parent.parent / "golden"


def recorded(name: str) -> dict[str, Any]:
    """A recording: what a `client` asked, a `server` answered, and what was sent."""
    found: dict[str, Any] = json.loads((_FOLDER / f"yarp4_{name}.json").read_text())
    return found


class Replay:
    """A port that answers as the C++ server did. What it was not asked then is a KeyError."""

    def __init__(self, name: str) -> None:
        self.answers: dict[str, list[str]] = {}
        for row in recorded(name)["server"]:
            self.answers.setdefault(row["request"], []).append(row["reply"])

    def ask(self, question: Any, timeout: float | None) -> Message:
        replies = self.answers[b"".join(question.to_wire()).hex()]
        reply = replies.pop(0) if len(replies) > 1 else replies[0]
        return Message(CALL, bytes.fromhex(reply))

    def tell(self, statement: Any) -> None:
        raise AssertionError("nothing is told")

    def close(self) -> None:
        """Nothing to do."""


def administer_as_yarp4(patch: pytest.MonkeyPatch) -> None:
    """Let ports know those administrative commands alone that C++ YARP 4 knows."""
    patch.setattr(admin, "graphs", SimpleNamespace(call=lambda name: None))  # none of ROS
    patch.delitem(admin._HANDLERS, "stat")


@contextmanager
def replay_device(name: str, rpc: str, stream: str, names: Any) -> Iterator[None]:
    """Ports that answer, and send, as the C++ device did."""
    port = Replay(name)

    def answer(message: Message) -> object:
        return Encoded(port.ask(Encoded(message.to_bytes()), None).to_bytes())

    with (
        yarpy.RpcServer(rpc, answer, names=names),
        yarpy.BufferedPort(stream, names=names) as source,
    ):
        ended = threading.Event()

        def send() -> None:
            while not ended.wait(0.01):
                source.write(Encoded(bytes.fromhex(recorded(name)["data"])))

        thread = threading.Thread(target=send)
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()
