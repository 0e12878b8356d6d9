"""UnbufferedContactable and AbstractContactable: what Port and the rpc ports have in common.

Rules: a subclass of AbstractContactable says in `asPort` whose methods it has.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarp._contactable import Contactable


class UnbufferedContactable(Contactable):
    """A port that writes and reads at once. Subclasses say how."""

    def write(self, writer: Any, reader: Any = None, callback: Any = None) -> bool:
        """Send, or ask."""
        raise NotImplementedError(f"{type(self).__name__} has to define write")

    def read(self, reader: Any, willReply: bool = False) -> bool:
        """Wait for a message."""
        raise NotImplementedError(f"{type(self).__name__} has to define read")

    def reply(self, writer: Any) -> bool:
        """Answer."""
        raise NotImplementedError(f"{type(self).__name__} has to define reply")

    def replyAndDrop(self, writer: Any) -> bool:
        """Answer, and end the connection."""
        raise NotImplementedError(f"{type(self).__name__} has to define replyAndDrop")


class AbstractContactable(UnbufferedContactable):
    """A port that is another one: each method is that of `asPort()`."""

    def asPort(self) -> Any:
        """Return the port whose methods these are."""
        raise NotImplementedError(f"{type(self).__name__} has to define asPort")


def _that_of_the_port(name: str) -> Callable[..., Any]:
    def method(self: Any, *arguments: Any, **more: Any) -> Any:
        port = self.asPort()
        owner = super(AbstractContactable, self) if port is self else port
        return getattr(owner, name)(*arguments, **more)

    method.__name__ = name
    method.__doc__ = getattr(UnbufferedContactable, name).__doc__
    return method


for _name in [*vars(Contactable), *vars(UnbufferedContactable)]:
    if not _name.startswith("_"):
        setattr(AbstractContactable, _name, _that_of_the_port(_name))
