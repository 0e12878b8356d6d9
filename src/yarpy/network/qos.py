"""The priority of any connection in the network, read from and set at the ports at its two ends.

Rules: the messages are those of C++ tools, so ports of any YARP answer; each
end has its own settings. Settings that a side should keep are left out.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.names.base import NameClient
from yarpy.network.asking import admin, called
from yarpy.qos import Qos, Sched, policy_of


def granted(source: str, target: str, names: NameClient | None = None) -> tuple[Qos, Qos]:
    """Return what the sender's and the receiver's system grant the connection `source` -> `target`.

    Raises UnknownName when there is no such port or connection, LinkClosed, Timeout.
    """
    _check_direction(source, target, names)
    return _granted(source, target, names), _granted(target, source, names)


def grant(
    source: str,
    target: str,
    *,
    sender: Qos | None = None,
    receiver: Qos | None = None,
    names: NameClient | None = None,
) -> None:
    """Ask for a priority at one end or both.

    Raises UnknownName when there is no such port or connection, LocalProtocolError when a port or
    its system refuses.
    """
    _check_direction(source, target, names)
    for qos, port, peer in ((sender, source, target), (receiver, target, source)):
        if qos is not None:
            name, _ = _find(port, peer, names)
            reply = admin(port, "prop", "set", name, *groups(qos), names=names)
            if not (reply and plain_text(reply[0]) == "ok"):
                reason = plain_text(reply[1]) if len(reply) > 1 else "the system refuses it"
                raise LocalProtocolError(f'"{port}" does not set this for "{peer}": {reason}')
            if qos.deadline or qos.rate:
                _confirm(port, peer, names)


def _check_direction(source: str, target: str, names: NameClient | None) -> None:
    """Raise UnknownName where there is a connection from `target` to `source` alone. Both ends know
    it by the other's name, and would change it."""
    there, back = (
        any(plain_text(one) == target for one in admin(source, "list", side, names=names))
        for side in ("out", "in")
    )
    if back and not there:
        raise UnknownName(
            f'"{source}" does not send to "{target}", but hears from it: the sender stands first, '
            f"{target} {source}"
        )


def _confirm(port: str, peer: str, names: NameClient | None) -> None:
    """A port of C++ says yes to words that it does not know."""
    if not _granted(port, peer, names).timed:
        raise LocalProtocolError(
            f'"{port}" is no port of yarpy, and keeps no deadlines; ask the end of "{peer}", if '
            "that is one"
        )


def _granted(port: str, peer: str, names: NameClient | None) -> Qos:
    return _find(port, peer, names)[1]


def _find(port: str, peer: str, names: NameClient | None) -> tuple[str, Qos]:
    """Return the name that `port` gives its connection with `peer`, and the QoS that it grants."""
    reply = admin(port, "prop", "get", peer, names=names)
    if not _is_told(reply):
        peer = called(port, asked := peer, names)
        reply = admin(port, "prop", "get", peer, names=names) if peer != asked else Bottle()
    if _is_told(reply):
        return peer, read(reply)
    raise UnknownName(
        f'"{port}" has no connection with "{peer}"; `yarpy ping {port}` lists those it has'
    )


def _is_told(reply: Bottle) -> bool:
    return bool(reply) and reply[0] != Vocab("fail")


def read(reply: Bottle) -> Qos:
    """The answer of a port to `prop get PEER`."""
    sched, packets = _group(reply, "sched"), _group(reply, "qos")
    found = Qos.of(
        Sched(_number(sched.get("policy")), _number(sched.get("priority"))),
        _number(packets.get("tos")),
    )
    timing = {key: _plain(value) for key, value in _group(reply, "timing").items()}
    try:
        return replace(found, **{key: timing.get(key) for key in ("deadline", "rate", "late")})
    except ValueError:  # what no port of ours says
        return found


def _group(reply: Bottle, key: str) -> dict[str, object]:
    """A group of a reply; over text a dict has become a list of pairs."""
    value = reply.find(key)
    pairs = value.items() if isinstance(value, dict) else value or ()
    return {plain_text(key): value for key, value in pairs}


def _plain(value: object) -> Any:
    return plain_text(value) if isinstance(value, str) else value


def _number(value: object) -> int:
    return value if isinstance(value, int) else -1


def groups(qos: Qos) -> list[object]:
    groups: list[object] = []
    if qos.policy is not None or qos.priority is not None:
        sched: list[object] = []
        if qos.priority is not None:
            sched.append(["priority", qos.priority])
        if qos.policy is not None:
            sched.append(["policy", policy_of(qos.policy)])
            if qos.priority is None and policy_of(qos.policy) == 0:
                sched.append(["priority", 0])
        groups.append(["sched", sched])
    if qos.packets is not None:
        groups.append(["qos", [["tos", qos.tos]]])
    if qos.timed:
        told = {"deadline": qos.deadline, "rate": qos.rate, "late": qos.late}
        groups.append(
            ["timing", [[key, value] for key, value in told.items() if value is not None]]
        )
    return groups
