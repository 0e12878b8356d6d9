"""The file behind `yarpy connect --file`: connections, with the priority that each gets.

    [camera]
    from     /robot/cam
    to       /view
    carrier  fast_tcp
    sender   (qos HIGH)
    receiver (sched FIFO 30) (qos LOW) (deadline 0.02) (rate 50) (late drop)

Rules: a group per connection, `from` and `to` are needed, `carrier` is tcp unless given. `sender`
and `receiver` are what `yarpy qos` and `yarpy sched` set. Everything is read and checked before
anything is connected.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yarpy
from yarpy.config.ini import read_ini
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.link.begin.handshake import asked_carrier
from yarpy.qos import Qos
from yarpy.route import parse_carrier

KEYS = ("from", "to", "carrier", "sender", "receiver")


@dataclass(frozen=True)
class Wire:
    """A connection of the file."""

    source: str
    target: str
    carrier: str
    sender: Qos | None
    receiver: Qos | None

    def make(self) -> None:
        """Connect, and set the priorities. Raises YarpError."""
        from yarpy.network import qos

        yarpy.connect(self.source, self.target, self.carrier)
        if self.sender is not None or self.receiver is not None:
            qos.grant(self.source, self.target, sender=self.sender, receiver=self.receiver)


def read(path: Path) -> list[Wire]:
    """The connections of a file. Raises OSError, LocalProtocolError naming the group at fault."""
    groups = read_ini(path)
    wires = []
    for name in groups:
        group = groups.group(name)
        if group is None or not any(isinstance(item, Bottle) for item in group[1:]):
            raise LocalProtocolError(f'"{name}" stands outside of any [group] in {path}')
        try:
            wires.append(_wire(Property.from_bottle(group[1:])))
        except (ValueError, YarpError) as error:
            raise LocalProtocolError(f"[{name}] in {path}: {error}") from error
    if not wires:
        raise LocalProtocolError(f"{path} names no connections")
    return wires


def _wire(group: Property) -> Wire:
    for key in group:
        if key not in KEYS:
            raise LocalProtocolError(f'"{key}" is none of {", ".join(KEYS)}')
    if "from" not in group or "to" not in group:
        raise LocalProtocolError("a connection needs from and to")
    source, target, carrier = (_text(group, key) for key in ("from", "to", "carrier"))
    asked_carrier(parse_carrier(carrier or ""))
    return Wire(source, target, carrier or "tcp", _qos(group, "sender"), _qos(group, "receiver"))


def _text(group: Property, key: str) -> str:
    return plain_text(group.get(key, ""))


def _qos(group: Property, key: str) -> Qos | None:
    """`(sched FIFO 30) (qos HIGH)`."""
    found = group.group(key)
    if found is None:
        return None
    policy = priority = packets = None
    timing: dict[str, Any] = {}
    for item in found[1:]:
        words = list(item) if isinstance(item, Bottle) else [item]
        if words[:1] == ["qos"] and len(words) == 2:
            packets = words[1]
        elif words[:1] == ["sched"] and len(words) in (2, 3):
            policy, priority = words[1], words[2] if len(words) == 3 else None
        elif words[:1] and words[0] in ("deadline", "rate", "late") and len(words) == 2:
            timing[words[0]] = words[1]
        else:
            raise LocalProtocolError(
                f"{key} takes (sched POLICY PRIORITY), (qos LEVEL), (deadline SECONDS), (rate HZ) "
                f"and (late drop), not {Bottle([item])}"
            )
    return Qos(policy, priority, packets, **timing)
