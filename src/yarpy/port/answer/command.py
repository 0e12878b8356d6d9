"""Port commands: what connects, disconnects and describes a port, in the words that telnet users
see.

Rules: the lines are those of C++ YARP.
"""

from __future__ import annotations

from yarpy.contact import parse_contact
from yarpy.errors import YarpError
from yarpy.link.receive.inbound import Inbound
from yarpy.log import logger
from yarpy.port.connect import refusal
from yarpy.port.connect.connecting import dial
from yarpy.port.connect.disconnecting import disconnect_input, disconnect_output
from yarpy.port.connect.target import joined
from yarpy.port.hub import Hub
from yarpy.route import masked
from yarpy.wire.message import Message

log = logger("yarpy.port")

HELP = (
    "This is a YARP port.  Here are the commands it responds to:",
    "*       Gives a description of this port",
    "d       Signals the beginning of input for the port's owner",
    'do      The same as "d" except replies should be suppressed ("data-only")',
    "q       Disconnects",
    "r       Reverse connection type to be a reader",
    "/port   Requests to send output to /port",
    "!/port  Requests to stop sending output to /port",
    "~/port  Requests to stop receiving input from /port",
    "a       Signals the beginning of an administrative message",
    "?       Gives this help",
)
NOT_UNDERSTOOD = (
    "Port command not understood.",
    "Type d to send data to the port's owner.",
    "Type ? for help.",
)


def obey(hub: Hub, link: Inbound, message: Message) -> list[str]:
    """Carry out a port command that came over `link`; the lines to answer a person with."""
    key, rest = message.key, message.text
    if key == "/":
        return [connect(hub, "/" + rest)[1]]
    if key == "!":
        return [disconnect_output(hub, rest)[1]]
    if key == "~":
        asked_for_itself = link.route.source == rest
        _, line = disconnect_input(hub, rest, by_sender=True)
        return [] if asked_for_itself else [line]
    if key == "*":
        return describe(hub)
    if key in ("?", "h"):
        return [*HELP]
    return [*NOT_UNDERSTOOD]


def connect(hub: Hub, text: str, carrier: str = "") -> tuple[bool, str]:
    """Connect `hub` to the destination `text` (`/name`, `carrier://name`, `/host:port`); whether
    that was possible, and the line that says so."""
    given, text = text, f"{carrier}:/{text}" if carrier else text  # as `guard` has judged it
    shown = masked(text)
    try:
        joined(given, carrier)
        wanted = parse_contact(text)
        spec = dial(hub, wanted)
    except YarpError as error:
        line = refusal.line(error, shown)
        log.warning("%s: %s", hub.name, line if str(error) in line else f"{line}: {error}")
        return False, line
    if spec.chosen and spec.base != "tcp":
        shown = f"{spec}:/{shown}"
    line = f"Added connection from {hub.name} to {shown}"
    if spec.log is not None:
        line += f"; {hub.name} will forward messages and replies (if any) to {wanted.label}"
    return True, line


def describe(hub: Hub) -> list[str]:
    """Return the lines in which a port describes itself and its connections."""
    lines = [f"This is {hub.name} at tcp://{hub.contact.host}:{hub.port}/"]
    for output in hub.outputs.links:
        route = output.route
        lines.append(
            f"There is an output connection from {hub.name} to {route.target} using {route.carrier}"
        )
    if not hub.outputs.links:
        lines.append("There are no outgoing connections")
    for link in hub.inputs.links:
        route = link.route
        lines.append(
            f"There is an input connection from {route.source} to {hub.name} using {route.carrier}"
        )
    if not hub.inputs.links:
        lines.append("There are no incoming connections")
    return lines
