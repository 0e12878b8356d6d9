"""MonitorConformance: what every monitor must do, as tests to inherit.

    class TestMine(MonitorConformance):
        monitor = MyMonitor                 # the class, or what returns one
        tokens = ("period_ms.1",)           # its parameters in a carrier string

Rules: messages alone, without ports; plain asserts. A monitor sees what strangers send, so that it
may raise for what is none of its business (the message is then dropped), but never anything that
would end the program.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from yarpy.data import codec
from yarpy.errors import YarpError
from yarpy.monitors.base import DROP, FAILURES, Place
from yarpy.wire.message import DATA, Message

METHODS = ("accept", "update", "update_reply", "trigger", "configure", "parameters", "state")
STRANGE = (b"", b"\0", b"\xff" * 4, bytes(64), b"{" * 100, bytes(range(256)) * 16)


class MonitorConformance:
    """Subclass it and set `monitor`.

    tokens: its parameters. sending: it works at the sender's end. values: messages that it should
    let pass.
    """

    monitor: ClassVar[Callable[[Place], Any]]
    tokens: ClassVar[Sequence[str]] = ()
    sending: ClassVar[bool] = True
    values: ClassVar[Sequence[Any]] = (["hello", 1, 2.5],)

    def made(self) -> Any:
        """Return a monitor between two ports."""
        place = Place(
            "/suite/out", "/suite/in", "tcp", sending=self.sending, tokens=(*self.tokens,)
        )
        return type(self).__dict__.get("monitor", type(self).monitor)(place)

    def test_has_something_to_do(self) -> None:
        monitor = self.made()
        assert any(hasattr(monitor, name) for name in METHODS), "no method of a monitor"
        _close(monitor)

    def test_lets_messages_pass(self) -> None:
        monitor = self.made()
        for value in self.values:
            message = Message(DATA, b"".join(bytes(block) for block in codec.encode(value)))
            if hasattr(monitor, "accept"):
                assert isinstance(monitor.accept(message), bool)
            if hasattr(monitor, "update"):
                found = monitor.update(message)
                assert found is not DROP, f"{value!r} is dropped"
                if found is not None and not isinstance(found, Message):
                    assert codec.encode(found), "what it gives can be sent"
        _close(monitor)

    def test_survives_what_strangers_send(self) -> None:
        monitor = self.made()
        for data in STRANGE:
            message = Message(DATA, data)
            for name in ("accept", "update", "update_reply"):
                if hasattr(monitor, name):
                    try:
                        getattr(monitor, name)(message)
                    except FAILURES:
                        pass  # the message is dropped, and the error logged
        _close(monitor)

    def test_tells_of_itself_in_plain_values(self) -> None:
        monitor = self.made()
        for name in ("parameters", "state"):
            if hasattr(monitor, name):
                found = getattr(monitor, name)()
                assert isinstance(found, dict) and all(isinstance(key, str) for key in found)
                assert codec.encode(found)
        _close(monitor)

    def test_refuses_wrong_parameters_with_an_error_of_ours(self) -> None:
        tokens = [f"{token.partition('.')[0]}.(nonsense" for token in self.tokens]
        place = Place("/suite/out", "/suite/in", "tcp", sending=self.sending, tokens=(*tokens,))
        try:
            _close(type(self).__dict__.get("monitor", type(self).monitor)(place))
        except (YarpError, ValueError):
            pass  # the connection is refused with that text

    def test_ends_twice_without_harm(self) -> None:
        monitor = self.made()
        _close(monitor)
        _close(monitor)


def _close(monitor: Any) -> None:
    if hasattr(monitor, "close"):
        monitor.close()
