"""The administrative channel of a port: a Bottle in, a Bottle out.

Rules: the commands and replies are those of C++ YARP 3.9, to the letter,
line ends inside strings included. A word counts by its first four characters, string or vocab
alike.
"""

from __future__ import annotations

import os
import random
from collections.abc import Sequence
from typing import Any, Literal

from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import YarpError
from yarpy.limit import PROPERTIES
from yarpy.log import logger
from yarpy.port.answer import command
from yarpy.port.answer.prop import get_peer, get_self, set_peer, set_self
from yarpy.port.answer.report import report, report_one
from yarpy.port.connect import disconnecting
from yarpy.port.graph import Graph
from yarpy.port.hub import Hub
from yarpy.registry import graphs
from yarpy.wire.message import Message

log = logger("yarpy.port")


_OK = Vocab("ok")
_FAIL = Vocab("fail")
_WIDTH = 25
_HELP = (
    ("[help]", "give this help"),
    ("[ver]", "report protocol version information"),
    ("[add] $portname", "add an output connection"),
    ("[add] $portname $car", "add an output with a given protocol"),
    ("[del] $portname", "remove an input or output connection"),
    ("[list] [in]", "list input connections"),
    ("[list] [out]", "list output connections"),
    ("[list] [in]  $portname", "give details for input"),
    ("[list] [out] $portname", "give details for output"),
    ("[prop] [get]", "get all user-defined port properties"),
    ("[prop] [get] $prop", "get a user-defined port property (prop, val)"),
    ("[prop] [set] $prop $val", "set a user-defined port property (prop, val)"),
    ("[prop] [get] $portname", "get Qos properties of a connection to/from a port"),
    ("[prop] [set] $portname", "set Qos properties of a connection to/from a port"),
    (
        "[prop] [get] $cur_port",
        "get information about current process (e.g., scheduling priority, pid)",
    ),
    (
        "[prop] [set] $cur_port",
        "set properties of the current process (e.g., scheduling priority, pid)",
    ),
    ("[atch] [out] $prop", "attach a portmonitor plug-in to the port's output"),
    ("[atch] [in]  $prop", "attach a portmonitor plug-in to the port's input"),
    ("[dtch] [out]", "detach portmonitor plug-in from the port's output"),
    ("[dtch] [in]", "detach portmonitor plug-in from the port's input"),
)
_PRAYERS = (
    "The gears of fate turn without a sound.",
    "A warm motor is a happy motor.",
    "Packets may be lost, hope is acknowledged.",
    "You feel that your encoders are true.",
)


def failure(text: str = "") -> Bottle:
    """`[fail] "text"`."""
    return Bottle([_FAIL, text] if text else [_FAIL])


def word(value: Any) -> str:
    """An element as a command word: the first four characters of a string or vocab."""
    return str(value)[:4] if isinstance(value, str) else ""


def answer(hub: Hub, message: Message) -> Bottle:
    """The reply to an administrative message; what goes wrong is `[fail]` and the reason."""
    try:
        return _answer(hub, message)
    except YarpError as error:
        return failure(str(error))


def _answer(hub: Hub, message: Message) -> Bottle:
    request = message.as_(Bottle)
    name = plain_text(request[0]) if request and isinstance(request[0], str) else ""
    if hub.callbacks.node is not None:
        answered = hub.callbacks.node(request)
        if answered is not None:
            return answered
    handler = _HANDLERS.get(word(request[0])) if request else None
    if handler is not None:
        return handler(hub, request)
    called = graphs.call(name)
    if called is not None and called[1].everywhere:
        graph: Graph = graphs.load(called[0])()
        return graph.answer(called[1].name, hub)
    on_admin = hub.callbacks.program.on_admin
    if on_admin is not None:
        reply = on_admin(message)
        if reply is not None:
            return Bottle(reply) if isinstance(reply, (list, tuple)) else Bottle([reply])
    return failure("send [help] for list of valid commands")


def _text(request: Sequence[Any], index: int) -> str:
    return plain_text(request[index]) if len(request) > index else ""


def _help(hub: Hub, request: Bottle) -> Bottle:
    lines = [f"{syntax:<{_WIDTH - 1}}# {meaning}" for syntax, meaning in _HELP]
    return Bottle([Vocab("many"), *lines])


def _version(hub: Hub, request: Bottle) -> Bottle:
    return Bottle([Vocab("ver"), 1, 2, 3])


def _add(hub: Hub, request: Bottle) -> Bottle:
    dest, carrier = _text(request, 1), _text(request, 2)
    if not carrier and ":/" in dest and "://" not in dest:
        return Bottle([-1, f"Do not know how to connect to {dest}\r\n"])
    done, line = command.connect(hub, dest, carrier)
    return Bottle([0 if done else -1, f"{line}\r\n"])


def _delete(hub: Hub, request: Bottle) -> Bottle:
    name = _text(request, 1)
    out, out_line = disconnecting.disconnect_output(hub, name)
    in_, in_line = disconnecting.disconnect_input(hub, name)
    lines = [line for found, line in ((out, out_line), (in_, in_line)) if found]
    if not lines:
        return Bottle([-1, f"{out_line}\r\n{in_line}\r\n"])
    return Bottle([0, "".join(f"{line}\r\n" for line in lines)])


def _list(hub: Hub, request: Bottle) -> Bottle:
    incoming = word(request[1]) == "in" if len(request) > 1 else False
    routes = [
        (link.route, link.carrier) for link in (hub.inputs.links if incoming else hub.outputs.links)
    ]
    if len(request) < 3:
        return Bottle([route.source if incoming else route.target for route, _ in routes])
    name = _text(request, 2)
    reply = Bottle()
    for route, carrier in routes:
        if name != (route.source if incoming else route.target):
            continue
        reply += [
            Bottle(["from", route.source]),
            Bottle(["to", route.target]),
            Bottle(["carrier", route.carrier]),
        ]
        if carrier.delivery.connectionless:
            reply.append(Bottle(["connectionless", 1]))
        if not carrier.push:
            reply.append(Bottle(["push", 0]))
    return reply


def _configure(hub: Hub, request: Bottle) -> Bottle:
    return _parameters(hub, request, setting=True)


def _inquire(hub: Hub, request: Bottle) -> Bottle:
    return _parameters(hub, request, setting=False)


def _parameters(hub: Hub, request: Bottle, setting: bool) -> Bottle:
    """[set] and [get]: parameters of what rides on a connection, or on the port itself."""
    side, name = _side(request), _text(request, 2)
    if side is None or not name:
        return Bottle([-1, "target port is not specified.\r\n"])
    chain = hub.monitoring.chain(side, name)
    if name == hub.name:
        if chain is None:
            return failure(f"No port modifier is attached to the {side}put")
        if not setting:
            return Bottle([chain.parameters()])
        chain.configure(Property.from_bottle(request[3:]))
        return Bottle([_OK])
    peers = (
        [link.route.source for link in hub.inputs.links]
        if side == "in"
        else [link.route.target for link in hub.outputs.links]
    )
    preposition = "from" if side == "in" else "to"
    if name not in peers:
        return Bottle([-1, f"Could not find an incoming connection {preposition} {name}\r\n"])
    if not setting:
        return Bottle([Property() if chain is None else chain.parameters()])
    if chain is not None:
        chain.configure(Property.from_bottle(request[3:]))
    return Bottle([0, f"Configured connection {preposition} {name}\r\n"])


def _side(request: Bottle) -> Literal["in", "out"] | None:
    """The side of a port that a request is about."""
    side = word(request[1]) if len(request) > 1 else ""
    return "in" if side == "in" else "out" if side == "out" else None


def _prop(hub: Hub, request: Bottle) -> Bottle:
    action, key = word(request[1]) if len(request) > 1 else "", _text(request, 2)
    if action == "get":
        if not key:
            return Bottle(
                Bottle([k, v] if v is not None else [k]) for k, v in hub.properties.sorted()
            )
        if key == hub.name:
            return get_self(hub)
        if key.startswith("/"):
            found = get_peer(hub, key)
            return found or failure(f"cannot find any connection to/from {key}")
        value = hub.properties.get(key)
        return Bottle() if value is None else Bottle([value])
    if action != "set":
        return failure("property action not known")
    if key and not hub.properties.keep(key, request[3] if len(request) > 3 else None):
        return failure(f"the properties of a port take at most {PROPERTIES} bytes")
    if not key.startswith("/"):
        return Bottle([_OK])
    try:
        set_self(hub, request) if key == hub.name else set_peer(hub, key, request)
    except ValueError as error:
        log.warning("%s: %s: %s", hub.name, request, error)  # the reply of C++ gives no reason
        return failure()
    except YarpError as error:
        return failure(str(error))
    return Bottle([_OK])


def _attach(hub: Hub, request: Bottle) -> Bottle:
    side = _side(request)
    if side is None:
        return failure("attach command must be followed by [out] or [in]")
    given = request[2:]
    told = len(given) == 1 and isinstance(given[0], str)  # C++ has the lists in one string
    parameters = Property.from_text(plain_text(given[0])) if told else Property.from_bottle(given)
    try:
        hub.monitoring.attach(side, parameters)
    except YarpError as error:
        return failure(f"Failed to configure the portmonitor plug-in: {error}")
    return Bottle([_OK])


def _detach(hub: Hub, request: Bottle) -> Bottle:
    side = _side(request)
    if side is None:
        return failure("detach command must be followed by [out] or [in]")
    hub.monitoring.detach(side)
    return Bottle([_OK])


def _statistics(hub: Hub, request: Bottle) -> Bottle:
    """[stat], or [stat] [in] $portname: ours; not in the help, which is that of C++."""
    side = _side(request)
    if side is None or len(request) < 3:
        return report(hub)
    return report_one(hub, side, _text(request, 2))


def _pray(hub: Hub, request: Bottle) -> Bottle:
    name = os.environ.get("YARP_ROBOT_NAME") or hub.name.split("/")[1 if "/" in hub.name else 0]
    return Bottle(
        [
            f"You begin praying to {name}.",
            "You finish your prayer.",
            random.Random().choice(_PRAYERS),
        ]
    )


_HANDLERS = {
    "help": _help,
    "ver": _version,
    "add": _add,
    "del": _delete,
    "list": _list,
    "set": _configure,
    "get": _inquire,
    "prop": _prop,
    "stat": _statistics,
    "atch": _attach,
    "dtch": _detach,
    "pray": _pray,
}
