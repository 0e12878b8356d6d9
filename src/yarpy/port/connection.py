"""Connections as users see them, and what they hear of one that comes or goes.

Rules: the texts of events are those C++ YARP logs. Transient clients (`admin`, tools without a name
that begins with a slash) are not reported.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from yarpy.link.qos import effective, grant
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.port.answer.monitoring import monitored
from yarpy.port.stats import ConnectionStats, RemoteStats, connection_stats
from yarpy.qos import Qos


class Connection:
    """A connection: who sends to whom, over what, and how it is doing.

    `carrier` is the protocol with its modifiers. `port.connect`, `port.outputs` and `port.inputs`
    give those of a port of this program; `yarpy.connect` gives one of any two ports, which are
    asked over the network each time.
    """

    def __init__(self, source: str, target: str, carrier: str) -> None:
        self.source = source
        self.target = target
        self.carrier = carrier

    @property
    def stats(self) -> ConnectionStats | RemoteStats:
        """The counts: `messages`, `bytes`, `drops`, `rate` (1/s), `jitter`, `latency` (s)
        ..."""
        raise NotImplementedError

    @property
    def qos(self) -> Qos:
        """The QoS that this connection really has. Assign a Qos to ask for something.

        Raises LocalProtocolError when the system refuses, telling what it wants; nothing is changed
        then.
        """
        raise NotImplementedError

    @qos.setter
    def qos(self, wanted: Qos) -> None:
        raise NotImplementedError

    @property
    def monitors(self) -> list[str]:
        """The names of the monitors that ride on it."""
        raise NotImplementedError

    def close(self) -> None:
        """End this connection."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"<Connection {self.source} -> {self.target} ({self.carrier})>"


class PortConnection(Connection):
    """A connection of a port of this program. `name` is the port at the other end."""

    def __init__(self, link: Inbound | Outbound, close: Callable[[], None]) -> None:
        self._link = link
        self._close = close
        super().__init__(link.route.source, link.route.target, link.route.carrier)

    @property
    def name(self) -> str:
        """The port at the other end."""
        return self.source if isinstance(self._link, Inbound) else self.target

    @property
    def stats(self) -> ConnectionStats:
        """The counts of this end.

        For every mode: messages sent = messages delivered + drops, counted where they happen. Once
        a connection has broken, some of those `unconfirmed` may have been delivered as well.
        """
        return connection_stats(self.source, self.target, self.carrier, self._link.snapshot())

    @property
    def qos(self) -> Qos:
        """The QoS that this connection really has: its thread's scheduling, and the priority of the
        packets that leave on our side. Assign a Qos to ask for something.

        Raises LocalProtocolError when the system refuses, telling what it wants; nothing is changed
        then. An output that is given a scheduling policy sends from a thread of its own.
        """
        return effective(self._link)

    @qos.setter
    def qos(self, wanted: Qos) -> None:
        grant(self._link, wanted)

    @property
    def monitors(self) -> list[str]:
        """The names of the monitors that ride on our end."""
        return monitored(self._link)

    def close(self) -> None:
        """End this connection."""
        self._close()


@dataclass(frozen=True, slots=True)
class ConnectionEvent:
    """`incoming`: into the port or out of it; `created`: it came or it went; `reason` says why."""

    incoming: bool
    created: bool
    source: str
    target: str
    carrier: str
    reason: str = ""

    def __str__(self) -> str:
        verb = {
            (True, True): "Receiving input",
            (True, False): "Removing input",
            (False, True): "Sending output",
            (False, False): "Removing output",
        }[self.incoming, self.created]
        text = f"{verb} from {self.source} to {self.target}"
        if self.created:
            text += f" using {self.carrier}"
        return f"{text} ({self.reason})" if self.reason else text
