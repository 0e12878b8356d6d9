"""The newest messages of the ports that people look at on the page of a network.

Rules: a port is looked at while a page asks for it, and a moment longer; a few at a time. A port
that writes is looked at itself, one that receives by the port it hears from, one that answers
questions by those; where one way shows nothing the next is tried. What is long is not decoded.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import Any, Final

import yarpy
from yarpy.data.sig import jpeg
from yarpy.kits.views.picture import visible
from yarpy.network.peek import Peek
from yarpy.network.traffic import Snapshot

MOST: Final = 16  # ports that are looked at
WANTED: Final = 5.0  # seconds after the last question for one
LONGEST: Final = 1 << 16  # bytes of a message that is spelled out
SHOWN: Final = 2000  # characters of it
QUALITY: Final = 70  # of JPEG


#: whose messages are looked at, and whether these are questions
Attempt = tuple[str, bool]


@dataclass(slots=True)
class _Look:
    peek: Peek
    of: str  # whose messages they are, if not the port's own
    attempts: list[Attempt]  # that were not tried yet
    asked: float = field(default_factory=time.monotonic)
    seen: tuple[float, int] = (0.0, 0)  # when messages were counted, and how many
    rate: float = 0.0


class Peeks:
    """The ports that pages look at."""

    def __init__(self) -> None:
        self._looks: dict[str, _Look] = {}
        self._lock = threading.Lock()  # pages ask in threads of their own

    def told(self, name: str, snapshot: Snapshot | None) -> dict[str, Any]:
        """The newest message of the port called `name`: plain data for a page."""
        try:
            look = self._look(name, snapshot)
        except (yarpy.YarpError, OSError) as error:
            return {"count": 0, "problem": str(error)[:300]}
        peek, message, now = look.peek, look.peek.newest, time.monotonic()
        look.asked = now
        since, counted = look.seen
        if now - since > 0.9:
            look.rate = (peek.count - counted) / (now - since) if since else 0.0
            look.seen = now, peek.count
        told = {"count": peek.count, "rate": look.rate, "of": look.of, "problem": ""}
        if message is None:
            return {**told, "problem": peek.ended[:300]}
        text = "" if is_image(message) else spelled(message)
        return {**told, "age": now - peek.at, "image": not text, "text": text}

    def picture(self, name: str) -> bytes | None:
        """The newest picture of a port that is looked at, as a JPEG file."""
        look = self._looks.get(name)
        message = look.peek.newest if look is not None else None
        if message is None or not is_image(message):
            return None
        try:
            return bytes(jpeg.encode(visible(message.as_(yarpy.Image))[0], QUALITY))
        except ValueError:
            return None

    def rest(self, everybody: bool = False) -> None:
        """Look no longer at ports that nobody asks for."""
        with self._lock:
            now = time.monotonic()
            for name, look in list(self._looks.items()):
                if everybody or look.peek.ended or now - look.asked > WANTED:
                    self._looks.pop(name).peek.close()

    def _look(self, name: str, snapshot: Snapshot | None) -> _Look:
        with self._lock:
            found = self._looks.get(name)
            if found is not None and not (found.attempts and found.peek.ended):
                return found
            if snapshot is None:
                raise yarpy.UnknownName("the ports are being asked: a moment, please")
            if name not in snapshot.ports:
                raise yarpy.UnknownName(f'"{name}" is not registered')
            if found is not None:  # that port shows nothing
                self._looks.pop(name).peek.close()
            elif len(self._looks) >= MOST:
                raise yarpy.LocalProtocolError(f"{MOST} ports are looked at already: try later")
            (seen, questions), *left = found.attempts if found else _attempts(name, snapshot)
            peek = Peek(snapshot.ports[seen].contact, questions)
            of = f"from {seen}: " if seen != name else "questions: " if questions else ""
            self._looks[name] = _Look(peek, of, left)
            return self._looks[name]


def _attempts(name: str, snapshot: Snapshot) -> list[Attempt]:
    """The ports that may show what passes through another, the likeliest first."""
    flows, ports = snapshot.flows.values(), snapshot.ports
    if any(flow.source == name for flow in flows):
        return [(name, False)]
    sources = [flow.source for flow in flows if flow.target == name]
    writers = [one for one in sources if one in ports and not ports[one].is_rpc]
    asked = (name, True)
    return (
        [(writers[0], False), asked] if writers else [asked] if sources else [(name, False), asked]
    )


def is_image(message: yarpy.Message) -> bool:
    """Return whether a message holds a picture."""
    if message.spelling != "binary":
        return False
    try:
        image = message.as_(yarpy.Image)
    except (yarpy.YarpError, ValueError):
        return False
    return bool(image.width and image.height)


def spelled(message: yarpy.Message) -> str:
    """A message as text, as far as people read."""
    size = len(message.payload) if message.spelling == "binary" else 0
    if size > LONGEST:
        return f"({size} bytes)"
    try:
        text = message.as_(yarpy.Bottle).to_text()
    except (yarpy.YarpError, ValueError):
        return f"({size} bytes that are no list)"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]} ... ({len(text)} characters)"
