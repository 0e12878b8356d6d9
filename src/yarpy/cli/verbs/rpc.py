"""`yarpy rpc PORT [NAME]`: send lines to a port, print its replies.

Each line of standard input is Bottle text; its reply is printed as `Response: ...`, a reply that
begins with `[many]` as `Responses:` and one line for each of its elements. No port is opened: the
one that is asked sees the name `anon_rpc`, or NAME. With `--client LOCALPORT` there is one, waiting
for somebody to connect it to a server, and replies are printed bare.

When the target goes away it is asked again, up to three times, a moment apart. `help` is asked of
control boards as they want it asked, `[help] [all]`; at a terminal Tab offers what it lists. What a
typed service cannot take is said, and the next line is asked. A port of YARP 4 gets fractions as
it spells them.
Exit codes: 0 at the end of input; 1 the target cannot be reached.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final

import click

import yarpy
from yarpy.cli import prompt, typed
from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain, warn
from yarpy.errors import (
    DecodeError,
    LinkClosed,
    NoNameServer,
    RemoteProtocolError,
    UnknownName,
    WrongPort,
    YarpError,
)
from yarpy.wire.message import UNSENDABLE

if TYPE_CHECKING:
    from yarpy.contact import Contact
    from yarpy.port.connect.probe import Caller

PAUSES: Final = (0.2, 0.6, 1.2)  # seconds before each attempt to reach a target that went away
COMMANDS: Final = "*** Available commands:"
LATER: Final = "; `yarpy rpc --client /me` waits until /me is connected to a server"
HELP: Final = ["help"]
HELP_ALL: Final = [yarpy.Vocab("help"), yarpy.Vocab("all")]

Ask = Callable[[Any], Any]


class Target:
    """The port that is asked; its connection is made again when it breaks."""

    def __init__(self, port: str, name: str = "", admin: bool = False) -> None:
        """Dial `port`. Raises UnknownName, WrongPort, LinkClosed, Timeout, NoNameServer."""
        self._port = port
        self._name = name
        self._admin = admin
        self._foreign = False  # a node or service of another system
        self._contact: Contact | None = None  # where it was found
        self._yarp4: bool | None = None  # whether it is of YARP 4; None: nobody asked yet
        self._caller: Caller | None = self._dial()

    def ask(self, question: Any) -> Any:
        """The reply as a Bottle. Raises LinkClosed when the target stays away, DecodeError when a
        typed service takes nothing like `question`."""
        pauses = iter(PAUSES)
        while True:
            try:
                if self._caller is None:
                    self._caller = self._dial()
                reply = _bottle(self._caller.ask(self._spelled(question)))
                if self._admin and _ends_connection(question):
                    self._hang_up()  # the next question must not go where nobody reads it
                return reply
            except WrongPort:
                raise
            except UNSENDABLE as error:
                if self._foreign:
                    self._hang_up()
                    raise DecodeError(str(error)) from error
                raise RemoteProtocolError(
                    f'"{self._port}" does not answer as a port does ({error}); '
                    "a name server of C++ YARP is asked with `yarpy name list` or `yarpy name help`"
                ) from error
            except (LinkClosed, UnknownName) as error:
                self._caller = None
                pause = next(pauses, None)
                if pause is None:
                    raise LinkClosed(f'"{self._port}" went away: {error}') from error
                click.echo("Target disappeared, reconnecting...", err=True)
                time.sleep(pause)

    def close(self) -> None:
        """Hang up."""
        self._hang_up()

    def _spelled(self, question: Any) -> Any:
        """The question as the target reads it: YARP 4 has other tags for fractions."""
        from yarpy.data.yarp4 import to_yarp4
        from yarpy.port.connect.probe import introduce
        from yarpy.wire.message import Encoded

        data = yarpy.Bottle(question).to_bytes()
        newer = to_yarp4(data)
        if newer is data or self._foreign or self._admin:
            return question  # it is the same for all
        if self._yarp4 is None:
            self._yarp4 = False
            with suppress(YarpError, OSError):
                self._yarp4 = self._contact is not None and introduce(self._contact).yarp4
        return Encoded(newer) if self._yarp4 else question

    def _hang_up(self) -> None:
        caller, self._caller = self._caller, None
        if caller is not None:
            caller.close()

    def _dial(self) -> Caller:
        from yarpy.contact import parse_contact, reach
        from yarpy.network.asking import confirmed
        from yarpy.port.connect.probe import ANONYMOUS, Caller
        from yarpy.registry import graphs

        carrier = parse_contact(self._port).carrier or "tcp"
        name = self._name or ANONYMOUS
        found = self._contact = confirmed(self._port, carrier=carrier)
        self._yarp4 = None
        self._foreign = found.reaches.foreign or reach(carrier).topic
        if found.reaches.foreign:
            for graph in graphs:
                with suppress(NoNameServer):
                    graph().prepare()
        return Caller(found, name, carrier=carrier, admin=self._admin)


def converse(ask: Ask, history: str, label: str = "Response: ", port: str = "") -> None:
    """Ask line by line and print the replies. Where `port` says nothing at all in its first answer,
    it is said once what that may mean."""
    first = True
    for line in prompt.lines(history=history, complete=lambda: commands_of(ask)):
        try:
            question = typed.bottle(line)
        except yarpy.DecodeError as error:
            complain(str(error))
            continue
        try:
            reply = ask(question)
        except DecodeError as error:
            complain(str(error))
            continue
        if question == HELP and _refused(reply):
            reply = ask(yarpy.Bottle(HELP_ALL))
        print_reply(reply, label)
        if first and port and not reply:
            warn(
                f'the answer is empty: "{port}" has nothing to say to that, or it is a port that '
                "only sends or reads, which answers nobody"
            )
        first = False


def print_reply(reply: Any, label: str = "Response: ") -> None:
    """Print a reply; what begins with `[many]` is a list of lines."""
    from yarpy.data.text import plain_text

    items = many(reply)
    if items is None:
        print_line(label + reply.to_text())
        return
    if label:
        print_line("Responses:")
    for item in items:
        print_line("  " + plain_text(item))


def many(reply: Any) -> list[Any] | None:
    """The elements behind `[many]`, None for any other reply."""

    if not reply or not isinstance(reply[0], yarpy.Vocab) or reply[0] != "many":
        return None
    items = list(reply[1:])
    return list(items[0]) if len(items) == 1 and isinstance(items[0], list) else items


def commands_of(ask: Ask) -> list[str]:
    """The commands that the target's `help` lists, [] when it has no such list."""
    from yarpy.data.text import plain_text

    try:
        reply = ask(yarpy.Bottle(HELP))
        if _refused(reply):  # a control board: its lines are the commands
            found = many(ask(yarpy.Bottle(HELP_ALL))) or []
            return [plain_text(item).replace("[", "").replace("]", "") for item in found]
    except YarpError:
        return []
    items = many(reply)
    if items is None:
        items = reply[0] if reply and isinstance(reply[0], list) else reply
    words = [plain_text(item) for item in items]
    return words[1:] if words[:1] == [COMMANDS] else []


def _refused(reply: Any) -> bool:
    return bool(reply) and isinstance(reply[0], yarpy.Vocab) and reply[0] in ("nak", "fail")


def _ends_connection(question: Any) -> bool:
    """Return whether ports hang up after the answer, as they do after a call of nodes."""
    from yarpy.data.text import plain_text
    from yarpy.registry import graphs

    word = plain_text(question[0]) if question and isinstance(question[0], str) else ""
    return graphs.call(word) is not None


def talk(port: str, name: str = "", admin: bool = False) -> int:
    """`yarpy rpc PORT [NAME]` and `yarpy admin rpc PORT [NAME]`."""

    try:
        target = Target(port, name, admin)
    except YarpError as error:
        later = "" if admin or isinstance(error, NoNameServer) else LATER
        complain(f"Cannot make connection: {error}{later}")
        return 1
    try:
        converse(target.ask, f"rpc_{port}", port="" if admin else port)
    finally:
        target.close()
    return 0


def be_client(name: str, server: str) -> int:
    """`yarpy rpc --client NAME [SERVER]`."""
    from yarpy.cli.ports import open_port, send_to

    with open_port(lambda name: yarpy.RpcClient(name=name), name) as client:
        if server:
            send_to(client, server)

        def ask(question: Any) -> Any:
            client.wait_for_outputs()
            return _bottle(client.ask(question))

        converse(ask, f"rpc_{name}", label="")
    return 0


def _bottle(message: Any) -> Any:

    return yarpy.Bottle() if message is None else message.as_(yarpy.Bottle)


@click.command()
@click.argument("port")
@click.argument("name", default="")
@click.option(
    "--client", is_flag=True,
    help="Open PORT as a client, and wait until it is connected to a server (NAME, if given).",
)  # fmt: skip
def command(port: str, name: str, client: bool) -> int:
    """Send lines of standard input to PORT and print the replies. PORT sees us as NAME."""
    return be_client(port, name) if client else talk(port, name)
