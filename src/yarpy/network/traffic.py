"""Traffic: every connection in the network and its counters, asked of all registered ports.

Rules: ports are asked in parallel, each once, with a time limit; one that does not answer has no
connections. C++ ports report to whom they send, over what, and with which priority; what they do
not count is None.
"""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, Final

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import UnknownName, YarpError
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT
from yarpy.network import qos
from yarpy.network.connection import query
from yarpy.port import probe
from yarpy.qos import Qos

AT_ONCE: Final = 16  # ports asked at the same time
PATIENCE: Final = 1.0  # seconds for an answer


@dataclass(slots=True)
class End:
    """A connection as one of its ports sees it; None: that port does not count it.

    `rate` is in messages per second, `jitter` and `latency` (until a reply) in seconds.
    """

    carrier: str = ""
    messages: int | None = None
    bytes: int | None = None
    drops: int | None = None
    unconfirmed: int | None = None
    unconnected: int | None = None
    rate: float | None = None
    jitter: float | None = None
    latency: float | None = None
    qos: Qos = field(default_factory=Qos)
    monitors: list[str] = field(default_factory=list)
    parameters: dict[str, Any] = field(default_factory=dict)
    state: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Flow:
    """A connection of two ports, as the sender and the receiver see it.

    Without a target: what the sender dropped on connections that have ended, and what it wrote
    while it had none (`unconnected`).
    """

    source: str
    target: str
    sender: End | None = None
    receiver: End | None = None

    @property
    def carrier(self) -> str:
        """Its protocol with all modifiers."""
        ends = [end.carrier for end in (self.sender, self.receiver) if end is not None]
        return max(ends, key=len, default="")

    @property
    def drops(self) -> int | None:
        """Messages that either side dropped."""
        counted = [e.drops for e in (self.sender, self.receiver) if e and e.drops is not None]
        return sum(counted) if counted else None

    def measured(self, key: str) -> Any:
        """`messages`, `bytes`, `rate`, `jitter` or `latency`, from the side that knows it."""
        for end in (self.sender, self.receiver):
            value = getattr(end, key, None)
            if value:
                return value
        return getattr(self.sender or self.receiver, key, None)


def flows(names: NameClient | None = None) -> list[Flow]:
    """Every connection between registered ports, by source and target.

    Raises NoNameServer.
    """
    known = [one for one in (names or DEFAULT.current()).list() if _answers(one)]
    found: dict[tuple[str, str], Flow] = {}
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for port, told in zip(known, pool.map(_ask, known), strict=True):
            for source, target, end in told:
                flow = found.setdefault((source, target), Flow(source, target))
                if source == port.name:
                    flow.sender = end
                else:
                    flow.receiver = end
    return [found[key] for key in sorted(found)]


def flow(source: str, target: str, names: NameClient | None = None) -> Flow:
    """The connection `source` -> `target`, asked of these two ports.

    Raises UnknownName when neither knows of it, NoNameServer.
    """
    found = Flow(source, target)
    for name in (source, target):
        contact = query(name, names)
        if contact is None or not _answers(contact):
            continue
        for from_, to, end in ends(contact):
            if (from_, to) != (source, target):
                continue
            if name == source:
                found.sender = end
            else:
                found.receiver = end
    if found.sender is None and found.receiver is None:
        raise UnknownName(
            f'neither "{source}" nor "{target}" has a connection from the first to the second; '
            f"`yarpy ping {source}` lists those it has"
        )
    return found


def _answers(contact: Contact) -> bool:
    return contact.carrier == "tcp" and contact.name.startswith("/") and bool(contact.port)


def ends(contact: Contact) -> list[tuple[str, str, End]]:
    """The connections of one port, source and target first; none if it does not answer."""
    return [one for one in _ask(contact) if one[1]]


def _ask(contact: Contact) -> list[tuple[str, str, End]]:
    try:
        reply = probe.ask(contact, ["stat"], timeout=PATIENCE)
        if reply and reply[0] == Vocab("fail"):
            return list(_ask_each(contact))
        return [read(Property.from_bottle(_pairs(item))) for item in reply]
    except (YarpError, OSError):
        return []


def _pairs(item: Any) -> Bottle:
    """The `(key value)` lists of a connection, which may already be a dict."""
    return Bottle([key, value] for key, value in item.items()) if isinstance(item, dict) else item


def read(told: Property) -> tuple[str, str, End]:
    """One connection in the answer to [stat]: source, target and counters."""
    monitors = told.get("monitors")
    end = End(
        plain_text(told.get("carrier", "")),
        **{key: told.get(key) for key in ("messages", "bytes", "drops")},
        **{key: told.get(key) for key in ("unconfirmed", "unconnected")},
        **{key: told.get(key) for key in ("rate", "jitter", "latency")},
        qos=Qos(told.get("policy"), told.get("priority"), _packets(told.get("packets"))),
        monitors=[plain_text(one) for one in monitors] if isinstance(monitors, list) else [],
        parameters=_dict(told.get("parameters")),
        state=_dict(told.get("state")),
    )
    return plain_text(told.get("source", "")), plain_text(told.get("target", "")), end


def _dict(told: Any) -> dict[str, Any]:
    return dict(Property.from_bottle(_pairs(told))) if told else {}


def _packets(value: Any) -> str | int | None:
    text = str(value) if value is not None else "None"
    return None if text == "None" else int(text) if text.isdigit() else text


def _ask_each(contact: Contact) -> Iterable[tuple[str, str, End]]:
    """The connections of a port that has no counters."""
    for side in ("out", "in"):
        for name in map(plain_text, probe.ask(contact, ["list", side], timeout=PATIENCE)):
            if not name.startswith("/"):
                continue
            listed = probe.ask(contact, ["list", side, name], timeout=PATIENCE)
            qos_ = qos.read(probe.ask(contact, ["prop", "get", name], timeout=PATIENCE))
            ends = (contact.name, name) if side == "out" else (name, contact.name)
            yield *ends, End(plain_text(listed.find("carrier", "")), qos=qos_)


__all__ = ["End", "Flow", "ends", "flow", "flows", "read"]
