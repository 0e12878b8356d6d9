"""`yarpy name COMMAND ARGS...`: any command of the name server, as typed.

    list [PREFIX]   query NAME   register NAME [CARRIER [HOST [PORT]]]   unregister NAME
    set NAME KEY VALUE...   get NAME KEY   check NAME KEY VALUE   route A B   runners   gc   help
    bot ...   topic ...   subscribe ...   and whatever else a server understands

Where a ROS master is configured, its nodes, topics and services are listed too; and those of ROS 2
where RMW_IMPLEMENTATION, ZENOH_SESSION_CONFIG_URI or YARPY_ZENOH say that it goes over Zenoh. With
names on Zenoh there is no server: `list`, `query` and `get` ask the ports.

Arguments are values of Bottle text. `register` takes any address, a camera's for example; the word
`...` leaves a part to the server.

Differs from C++: commands that are answered with a Bottle (`bot`, `topic`, `subscribe` ...) print
it instead of waiting for ever; no empty line behind a registration; `register` claims nothing more
about the port than its address; no command is `help`.
Exit codes: 0 answered; 1 `query` finds nothing, the server knows no such command, or no server.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import click

import yarpy
from yarpy.cli.output import print_all_json, print_json, print_line
from yarpy.cli.stderr import complain

if TYPE_CHECKING:
    from yarpy.names.ros import RosNames
    from yarpy.names.zenoh import ZenohNames
    from yarpy.ros2.listing import Entry

END = "*** end of message"
#: What all servers understand.
COMMANDS = (
    *("list", "query", "register", "unregister", "set", "get", "check", "route", "runners", "gc"),
    *("help", "bot", "topic", "subscribe"),
)
#: What is answered with nothing at all, or may be.
_SILENT = frozenset(
    {"list", "query", "set", "get", "check", "route", "runners", "gc", "unregister"}
)
_BOTTLES = frozenset({"bot", "announce", "subscribe", "unsubscribe", "topic", "untopic", "type"})


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("words", nargs=-1, metavar="COMMAND [ARGS]...")
@click.option("--json", "as_json", is_flag=True, help="Print list, query, get ... as JSON.")
def command(words: tuple[str, ...], as_json: bool) -> int:
    """Send a command to the name server: `name list`, `name query /port`, `name help` ..."""
    from yarpy.cli.service import masters, server, zenoh_names
    from yarpy.config.command_line import parse_value
    from yarpy.network.connection import find

    verb, arguments = (words[0], words[1:]) if words else ("help", ())
    zenoh = zenoh_names()
    if zenoh is not None:
        return _answer_for_zenoh(verb, arguments, zenoh, as_json)
    graphs = masters() if verb in ("list", "query") else []
    if graphs and _answer_for_ros(verb, arguments, graphs, as_json):
        return 0
    client = server()
    if verb == "query" and len(arguments) == 1:
        _print_contact(client.query(arguments[0]) or find(arguments[0], client), as_json)
    elif verb == "list" and as_json:
        _print_list(client.list(*arguments[:1]), arguments)
    elif verb == "register" and arguments:
        _print_contact(client.register(*parse_address(arguments)), as_json)
    elif verb == "unregister" and len(arguments) == 1:
        client.unregister(arguments[0])
        print_line("Unregistered name.")
    elif verb in _BOTTLES:
        reply = client.request([verb, *map(parse_value, arguments)])
        print_json(reply) if as_json else print_line(reply.to_text())
    elif verb == "get" and as_json and len(arguments) == 2:
        print_json(client.get(*arguments))
    else:
        lines = client.command(verb, *map(parse_value, arguments))
        if not lines and verb not in _SILENT:
            complain(
                f'the name server does not know "{verb}"; `yarpy name help` lists its commands'
            )
            return 1
        if as_json:
            print_json(lines)
        else:
            ros2 = _lines_of_ros2(arguments) if verb == "list" else []
            for line in (*lines, *_lines_of(graphs, arguments), *ros2, END):
                print_line(line)
    return 0


def _answer_for_zenoh(
    verb: str, arguments: tuple[str, ...], names: ZenohNames, as_json: bool
) -> int:
    """What ports tell themselves, in the words of a name server."""
    from yarpy.names.registration_line import registration_line
    from yarpy.network.connection import find

    if verb == "query" and len(arguments) == 1:
        _print_contact(find(arguments[0], names), as_json)
    elif verb == "list":
        contacts = names.list(*arguments[:1])
        if as_json:
            _print_list(contacts, arguments)
        else:
            for line in (*map(registration_line, contacts), *_lines_of_ros2(arguments), END):
                print_line(line)
    elif verb == "get" and len(arguments) == 2:
        values = names.get(*arguments)
        if as_json:
            print_json(values)
        elif values:
            print_line(f"port {arguments[0]} property {arguments[1]} = {' '.join(values)}")
            print_line(END)
        else:
            print_line(END)
    else:
        complain(
            f'with names on Zenoh there is no server to ask for "{verb}", only ports, for list, '
            "query and get; `yarpy server --zenoh` is one, which keeps names and connections"
        )
        return 1
    return 0


def _answer_for_ros(
    verb: str, arguments: tuple[str, ...], graphs: list[RosNames], as_json: bool
) -> bool:
    """What ROS masters know, where there is no YARP server to ask, or both are asked for JSON;
    whether that is all."""
    from yarpy.names.default import DEFAULT

    names = DEFAULT.current()
    alone = names in graphs
    if verb == "query" and len(arguments) == 1 and alone:
        contact = names.query(arguments[0])
        if contact is None:
            from yarpy.port.connecting import unknown

            raise unknown(arguments[0], names)
        _print_contact(contact, as_json)
        return True
    if verb != "list" or not (alone or as_json):
        return False
    if as_json:
        asked = getattr(names, "clients", [names])
        _print_list((item for one in asked for item in one.list(*arguments[:1])), arguments)
    else:
        for line in (*_lines_of(graphs, arguments), *_lines_of_ros2(arguments), END):
            print_line(line)
    return True


def _lines_of(graphs: list[RosNames], arguments: tuple[str, ...]) -> list[str]:
    """Nodes, topics and services, as C++ lists them."""
    kinds = {"xmlrpc": "node", "topic": "topic", "rossrv": "service"}
    return [
        f'{kinds[item.carrier]} "{item.name}"'
        for graph in graphs
        for item in graph.list(*arguments[:1])
    ]


def _lines_of_ros2(arguments: tuple[str, ...]) -> list[str]:
    """Nodes, topics and services of ROS 2, by what they are connected to, if there is any."""
    return [f'{item.kind} "{item.target}"' for item in _listed_of_ros2(arguments)]


def _listed_of_ros2(arguments: tuple[str, ...]) -> list[Entry]:
    from yarpy.ros2.listing import is_used, listing

    if not is_used(os.environ):
        return []
    try:
        return listing("".join(arguments[:1]))
    except yarpy.YarpError as error:
        complain(f"ROS 2 is not listed: {error}")
        return []


def _print_list(contacts: Iterable[yarpy.Contact], arguments: tuple[str, ...]) -> None:
    """`list` for programs: ports, and what there is in ROS 2."""
    print_all_json(map(as_dict, contacts))
    for item in _listed_of_ros2(arguments):
        place = yarpy.Contact(item.carrier, item.name)
        print_json({**as_dict(place), "kind": item.kind, "type": item.type})


def parse_address(words: tuple[str, ...]) -> list[Any]:
    """`NAME [CARRIER [HOST [PORT]]]` as arguments of `register`; `...` is None."""
    values: list[Any] = [None if word == "..." else word for word in words[1:4]]
    if len(values) == 3 and values[2] is not None:
        if not values[2].isdigit() or not 0 < int(values[2]) < 65536:
            raise click.UsageError(f'"{values[2]}" is no port number: give 1 to 65535, or ...')
        values[2] = int(values[2])
    return [words[0], *values]


def as_dict(contact: yarpy.Contact) -> dict[str, Any]:
    """A registration for JSON."""
    return {
        "name": contact.name,
        "host": contact.host,
        "port": contact.port,
        "carrier": contact.carrier,
    }


def _print_contact(contact: yarpy.Contact, as_json: bool) -> None:
    from yarpy.names.registration_line import registration_line

    print_json(as_dict(contact)) if as_json else print_line(registration_line(contact))
