"""RemoteConnection: a connection of any two ports, inspected and changed over the network.

Rules: only the two names are kept; every request goes to the two ports. C++ ports answer all except
those for counters, which they do not have.
"""

from __future__ import annotations

from typing import Any

from yarpy.contact import parse_contact
from yarpy.names.base import NameClient
from yarpy.network import qos as remote_qos
from yarpy.network.connection import disconnect, join
from yarpy.network.sampling import flow
from yarpy.port.connection import Connection
from yarpy.port.stats import RemoteStats
from yarpy.qos import Qos

COUNTED = ("messages", "bytes", "rate", "jitter", "latency")


class RemoteConnection(Connection):
    """A connection of two ports, here or elsewhere. `reply`: the answer of the port that was asked
    to make it.

    Its properties raise UnknownName if the connection no longer exists (or the ports do not know
    it, as with a topic), LinkClosed and Timeout if a port does not answer.
    """

    def __init__(
        self, source: str, target: str, carrier: str, reply: str, names: NameClient | None
    ) -> None:
        super().__init__(source, target, carrier)
        self.reply = reply
        self._names = names

    @property
    def stats(self) -> RemoteStats:
        """The counts of the sender, or of the receiver if only that one counts; `replaced` and
        `drops` of both."""
        found = flow(self.source, self.target, self._names)
        counted: dict[str, Any] = {key: found.measured(key) for key in COUNTED}
        return RemoteStats(**counted, replaced=found.replaced, drops=found.drops)

    @property
    def qos(self) -> Qos:
        """The QoS that the sender's system grants this connection. Assign a Qos to change it.

        Raises LocalProtocolError if the port or its system refuses.
        """
        return remote_qos.granted(self.source, self.target, self._names)[0]

    @qos.setter
    def qos(self, wanted: Qos) -> None:
        remote_qos.grant(self.source, self.target, sender=wanted, names=self._names)

    @property
    def monitors(self) -> list[str]:
        """The names of the monitors attached to it, the sender's first."""
        found = flow(self.source, self.target, self._names)
        return [name for end in (found.sender, found.receiver) if end for name in end.monitors]

    def close(self) -> None:
        """End this connection, if it still exists. With a topic the subscription ends: no further
        ports are connected."""
        disconnect(self.source, self.target, names=self._names)


def connect(
    source: str,
    target: str,
    carrier: str = "",
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> RemoteConnection:
    """Connect two ports. An existing connection is remade.

    `source` or `target` may be `topic://name`. With `timeout`, wait that many seconds for ports
    that do not exist yet; without, it is tried once, for 5 s. Raises UnknownName, UnknownPlugin,
    LinkClosed, AccessRefused, LocalProtocolError (refused), NoNameServer.
    """
    used, reply = join(source, target, carrier, names=names, timeout=timeout)
    return RemoteConnection(_name(source), _name(target), used, reply, names)


def _name(text: str) -> str:
    """The name of this end as ports use it; a topic is left as written."""
    contact = parse_contact(text)
    return text if contact.carrier == "topic" else contact.label
