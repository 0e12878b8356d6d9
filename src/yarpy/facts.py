"""Facts: what can be asked of a plug-in without importing it.

Rules: pure values. What ships with yarpy has a row in `shipped.py`, whose facts are those of the
class (`tests/test_shipped.py`); of any other plug-in the class itself is asked, by the same names.
"""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, fields
from typing import Any, Final, Self

SYSTEM: Final = (sys.platform, os.name)  # what this one is called
_TITLES: Final = {"win32": "Windows", "darwin": "macOS", "linux": "Linux"}
MAGIC_SIZE: Final = 8  # bytes that identify the protocol of a connection


@dataclass(frozen=True, slots=True)
class Reach:
    """The kind of peer that a carrier leads to.

    `what`: a port of YARP; a server, which may know nothing of YARP, such as a camera;
    a socket, which besides has no name; a topic of a broker, at the host of that; a topic without
    any address. `number`, `number_tls`: the TCP port number of brokers that say none. `cpp`: what
    happens to such a connection with a port of C++ YARP, if it is of no use. `tells`: the initiator
    gives its name and modifiers. `same_program`: both ends are in one program, or of yarpy. `page`:
    a web page may be the initiator.
    """

    what: str = "port"
    number: int = 0
    number_tls: int = 0
    cpp: str = ""
    tells: bool = True
    same_program: bool = False
    page: bool = False

    @property
    def foreign(self) -> bool:
        """Return whether the peer that was dialled may know neither YARP nor its keys."""
        return self.what != "port"

    @property
    def told(self) -> bool:
        """Return whether the peer learns what is to ride at its end."""
        return self.tells and not self.foreign

    @property
    def nameless(self) -> bool:
        """Return whether a connection that breaks may be made again with whoever answers at the
        same address: the peer has no name that could be asked for."""
        return self.what in ("socket", "broker", "topic")

    @property
    def topic(self) -> bool:
        """Return whether the other end has a name and no address."""
        return self.what == "topic"

    @property
    def broker(self) -> bool:
        """Return whether the other end is a topic of a broker."""
        return self.what == "broker"


PORT: Final = Reach()
SERVER: Final = Reach("server")
SOCKET: Final = Reach("socket")
BROKER: Final = Reach("broker")
TOPIC: Final = Reach("topic")


@dataclass(frozen=True, slots=True)
class Row:
    """A plug-in: its name, where it is (`module:attribute`; "": in other programs alone), and the
    extra of yarpy that installs what it needs."""

    name: str
    target: str = ""
    extra: str = ""

    @property
    def home(self) -> str:
        """The ring that it belongs to, and its room there: `core`, `peers.ros`, `kits.sim`; "" for
        what does not ship with yarpy."""
        parts = self.target.partition(":")[0].split(".")
        if parts[0] != "yarpy":
            return ""
        return ".".join(parts[1:3]) if parts[1] in ("peers", "kits") else "core"

    @property
    def advice(self) -> str:
        """Return the command that installs what is missing."""
        return f'pip install "yarpy[{self.extra}]"' if self.extra else "pip install yarpy"


@dataclass(frozen=True, slots=True)
class CarrierRow(Row):
    """A carrier. `magic`: the ways in which connections of it may begin; of their bits only those
    in `mask` count, if there is one. What begins so may still be another carrier's: the class
    decides. `subprotocol`: of a WebSocket in whose frames it may come, too."""

    magic: tuple[bytes, ...] = ()
    mask: bytes = b""
    push: bool = True
    reaches: Reach = PORT
    over: str = ""
    subprotocol: str = ""

    def may_begin(self, first: bytes) -> bool:
        """Return whether these eight bytes may begin a connection of it."""
        if not self.mask:
            return first.startswith(self.magic)
        kept = int.from_bytes(first) & int.from_bytes(self.mask)
        return kept.to_bytes(len(self.mask)) in self.magic

    @classmethod
    def of(cls, name: str, plugin: Any) -> Self:
        """Return the facts of a carrier class. Raises AttributeError for what is none."""
        return cls(
            name,
            f"{plugin.__module__}:{plugin.__qualname__}",
            push=bool(plugin.push),
            reaches=plugin.reaches,
            over=plugin.over,
            subprotocol=plugin.subprotocol,
        )


@dataclass(frozen=True, slots=True)
class TransportRow(Row):
    """A transport.

    `hosts`: what the hosts end in that it alone leads to. `title`: what people call it. `setting`:
    the variable that has to be `yes` before a peer is met over it. `prefers`: the carrier for such
    hosts, where none was named. `no_tls`: why there is no TLS on it. `proves`: a peer's address is
    its own, not what it says. `meets`: of a connection over it the two ends can meet elsewhere.
    `stays`: what it carries does not leave the computer. `datagrams`: it carries these, which may
    be lost. `system`: the `sys.platform` or `os.name` that has it; "": each. `uses`: what of that
    system it uses.
    """

    hosts: str = ""
    title: str = ""
    setting: str = ""
    prefers: str = ""
    no_tls: str = ""
    proves: bool = True
    meets: bool = True
    stays: bool = False
    datagrams: bool = False
    system: str = ""
    uses: str = ""

    @property
    def here(self) -> bool:
        """Return whether this system has it."""
        return not self.system or self.system in SYSTEM

    @property
    def lacks(self) -> str:
        """Return why this system has not got it, "" if it has."""
        if self.here:
            return ""
        return f"not on {_TITLES.get(SYSTEM[0], SYSTEM[0])}: it needs {self.uses}"

    @classmethod
    def of(cls, name: str, plugin: Any) -> Self:
        """Return the facts of an Opener class. Raises AttributeError for what is none."""
        own = {one.name: getattr(plugin, one.name) for one in fields(TransportRow)[_PLACES:]}
        return cls(name, f"{plugin.__module__}:{plugin.__qualname__}", **own)


_PLACES: Final = len(fields(Row))


@dataclass(frozen=True, slots=True)
class Call:
    """A call that nodes of a graph make to each other, and the `word` for it among administrative
    requests. `changes`: it tells the node something, others only ask. `everywhere`: ports that
    belong to no node answer it too."""

    name: str
    word: str = ""
    changes: bool = False
    everywhere: bool = False


@dataclass(frozen=True, slots=True)
class GraphRow(Row):
    """The graph of another system, of whose nodes ports may be part."""

    calls: tuple[Call, ...] = ()
