"""Chain: the monitors at one end of a connection, one after the other.

Rules: a chain is made before its connection, so that a wrong name or parameter refuses it. Only the
methods that its monitors have are called. If a monitor fails, the message is dropped and a line
logged; the connection continues. What is dropped is counted for each monitor; what passes costs
nothing more.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final

from yarpy import registry
from yarpy.data import codec
from yarpy.data.bottle import Property
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.log import logger
from yarpy.monitors.base import DROP, FAILURES, Group, Place, Taken
from yarpy.route import CarrierSpec, Route
from yarpy.wire.message import Message, Packet

log = logger("yarpy.monitors")

_MOST_TOLD: Final = 16  # different errors that one chain logs
_PLAIN: Final = frozenset((list, tuple, dict))  # Python's types for Bottles and Properties


def make(name: str, place: Place) -> object:
    """The monitor called `name`, at its place. Raises UnknownPlugin, LocalProtocolError."""
    kind = registry.monitors.load(name)
    try:
        return kind(place)
    except YarpError:
        raise
    except FAILURES as error:
        raise LocalProtocolError(
            f'monitor "{name}" cannot start at {place}: {type(error).__name__}: {error}'
        ) from error


def from_carrier(spec: CarrierSpec, place: Place) -> list[object]:
    """The monitors that a carrier asks for at its sender's or receiver's end.

    They are attached at `place`, each with its own parameters. Raises like `make`.
    """
    made: list[object] = []
    try:
        for name, tokens in spec.send if place.sending else spec.recv:
            made.append(make(name, replace(place, tokens=tokens, shared=spec.tokens)))
    except YarpError:
        Chain(made, "").close()
        raise
    return made


def refused_there(spec: CarrierSpec, route: Route) -> str:
    """Return what is likely to be wrong with the monitors of the receiver's end, which hung up:
    what is wrong with them here."""
    monitors = ", ".join(name for name, _ in spec.recv)
    there = f"its log tells what is wrong with {monitors} there"
    place = Place(route.source, route.target, spec.whole, foreign=True)
    try:
        Chain(from_carrier(spec, place), "").close()
    except YarpError as error:
        return f"most likely {error} ({there})"
    return there


class _Tally:
    """The count of what one monitor has dropped, and its last failure."""

    __slots__ = ("dropped", "failure")

    def __init__(self) -> None:
        self.dropped = 0
        self.failure = ""


class Chain:
    """Monitors in their order, for one connection or one port."""

    def __init__(self, monitors: Sequence[object], where: str, group: Group | None = None) -> None:
        self.monitors = tuple(monitors)
        self._tallies = tuple(_Tally() for _ in monitors)
        self._where = where
        self._group = group
        # Only monitors of a group trigger the others.
        self._steps = tuple(
            (
                one if group is not None else None,
                getattr(one, "accept", None),
                getattr(one, "update", None),
                tally,
            )
            for one, tally in zip(self.monitors, self._tallies, strict=True)
        )
        self._watchers = tuple(one for one in monitors if hasattr(one, "confirmed"))
        self._replies = tuple(one.update_reply for one in monitors if hasattr(one, "update_reply"))
        self._lock = threading.RLock()  # several writers may use one connection
        self._told: set[str] = set()

    # -- messages ---------------------------------------------------------------------------------

    def take(self, message: Message) -> Message | None:
        """The received message after all monitors; None: it is dropped.

        Its reader cannot tell that it was changed: a list, for example, is a Bottle again.
        """
        made = self._through(message)
        if made is None or made is message or type(made.payload) not in _PLAIN:
            return made
        try:
            return made.replaced(b"".join(codec.encode(made.payload)), binary=True)
        except Exception as error:  # a value that no message can hold
            self._complain(error)
            return None

    def _through(self, message: Message) -> Message | None:
        """The message after all monitors; None: one has dropped it."""
        group = self._group
        tally = None
        try:
            for peer, accept, update, tally in self._steps:
                if accept is not None and not accept(message):
                    tally.dropped += 1
                    return None
                if peer is not None and group is not None:
                    group.trigger(peer)
                if update is not None:
                    made = update(message)
                    if made is DROP:
                        tally.dropped += 1
                        return None
                    if made is not None and made is not message:
                        message = made if isinstance(made, Message) else message.replaced(made)
        except FAILURES as error:
            if tally is not None:
                tally.dropped += 1
                tally.failure = _told(error)
            self._complain(error)
            return None
        return message

    def send(self, packet: Packet) -> Packet | None:
        """The packet after all monitors; None: it is dropped."""
        message = Message.of(packet)
        with self._lock:
            made = self._through(message)
        if made is None:
            return None
        return packet if made is message else Packet.of(made, packet)

    def reply(self, message: Message) -> Message:
        """The reply to a call after all monitors; a reply is never dropped."""
        try:
            for update in self._replies:
                made = update(message)
                if made is not None and made is not DROP and made is not message:
                    message = made if isinstance(made, Message) else message.replaced(made)
        except FAILURES as error:
            self._complain(error)
        return message

    # -- how they fare ----------------------------------------------------------------------------

    @property
    def watches(self) -> bool:
        """Return whether a monitor wants to know when messages are confirmed."""
        return bool(self._watchers)

    def watch(self, under_way: Callable[[], int]) -> None:
        """The connection exists: `under_way` tells how many messages are not confirmed."""
        for monitor in self._watchers:
            getattr(monitor, "watch", lambda _: None)(under_way)

    def confirmed(self, taken: Taken) -> None:
        """The receiver has taken a message."""
        try:
            for monitor in self._watchers:
                monitor.confirmed(taken)
        except FAILURES as error:
            self._complain(error)

    def _complain(self, error: BaseException) -> None:
        text = _told(error)
        if text not in self._told and len(self._told) < _MOST_TOLD:
            self._told.add(text)
            log.warning("%s: a monitor dropped a message: %s", self._where, text)

    def followed_by(self, other: Chain) -> Chain:
        """A chain of both; their owners close them."""
        group = self._group or other._group
        both = Chain((*self.monitors, *other.monitors), self._where, group)
        both._steps = self._steps + other._steps
        return both

    # -- parameters -------------------------------------------------------------------------------

    def configure(self, parameters: Property) -> bool:
        """Give new parameters to every monitor that takes any; returns whether one does."""
        able = [one for one in self.monitors if hasattr(one, "configure")]
        for monitor in able:
            monitor.configure(parameters)
        return bool(able)

    def parameters(self) -> Property:
        """The parameters of all monitors that have the method."""
        return self._told_by("parameters")

    def state(self) -> Property:
        """The state of all monitors that have the method."""
        return self._told_by("state")

    def _told_by(self, method: str) -> Property:
        found = Property()
        for monitor in self.monitors:
            told: Any = getattr(monitor, method, dict)
            found.update(told())
        return found

    @property
    def dropped(self) -> list[int]:
        """The number of messages that each monitor has dropped."""
        return [tally.dropped for tally in self._tallies]

    @property
    def failures(self) -> list[str]:
        """Return the last failure of each monitor, "" where there was none."""
        return [tally.failure for tally in self._tallies]

    def close(self) -> None:
        """The connection or port ends."""
        for monitor in self.monitors:
            if self._group is not None:
                self._group.remove(monitor)
            try:
                getattr(monitor, "close", lambda: None)()
            except FAILURES as error:
                log.warning("%s: a monitor did not close: %s", self._where, error)


def _told(error: BaseException) -> str:
    """An error as people are told of it."""
    return f"{error}" if isinstance(error, YarpError) else f"{type(error).__name__}: {error}"
