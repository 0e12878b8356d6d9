"""Series: several monitors in one request of C++ YARP 4, `file.A+type.dll+file1.B+type1.dll`.

Rules: they see a message one after the other, each with the changes of those before it. yarpy's own
notation, several `+send.` or `+recv.`, needs no series.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import Any

from yarpy.data.bottle import Property
from yarpy.monitors.base import DROP, Place
from yarpy.monitors.chain import Chain
from yarpy.wire.message import Message

_NUMBERED = ("type", "file", "context", "constraint")


def places(place: Place) -> list[Place]:
    """The place of each: the first as it is, the numbered ones with their numbers removed."""
    found = [place]
    for number in count(1):
        numbered = {f"{key}{number}": key for key in _NUMBERED}
        if place.find(f"type{number}") is None and place.find(f"file{number}") is None:
            return found
        tokens = tuple(_renamed(place.tokens, numbered))
        shared = tuple(_renamed(place.shared, numbered))
        found.append(replace(place, tokens=tokens, shared=shared))
    raise AssertionError


def _renamed(tokens: tuple[str, ...], numbered: dict[str, str]) -> list[str]:
    """The parameters of one: its own with numbers removed, and those without a number."""
    found = []
    for token in tokens:
        name, dot, value = token.partition(".")
        if name in numbered:
            found.append(f"{numbered[name]}{dot}{value}")
        elif name not in _NUMBERED:
            found.append(token)
    return found


class Series:
    """Monitors as one."""

    def __init__(self, monitors: list[object], place: Place) -> None:
        self._monitors = monitors
        self._chain = Chain(monitors, str(place))

    def update(self, message: Message) -> object:
        made = self._chain.take(message)
        return DROP if made is None else made

    def update_reply(self, message: Message) -> object:
        return self._chain.reply(message)

    def trigger(self) -> None:
        for one in self._monitors:
            getattr(one, "trigger", lambda: None)()

    def configure(self, parameters: Property) -> None:
        self._chain.configure(parameters)

    def parameters(self) -> Property:
        return self._chain.parameters()

    def state(self) -> dict[str, Any]:
        return self._chain.state()

    def close(self) -> None:
        self._chain.close()
