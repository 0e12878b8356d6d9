"""`yarpy read PORT [REMOTE...] [envelope] [trim [N]] [once]`: print what arrives at a port.

Prints each message as a line of Bottle text. An integer and a string are a line that somebody sent
verbatim: only the string is printed, and the integer 1 ends the reader. Of images, sounds, point
clouds and arrays the kind and the size are printed; `--json` prints all of it. What a program in
Python said of its types (`yarpy.type`) is no element, but obeyed.

Differs from C++: an image is not printed byte by byte, and sounds and point clouds are printed; a
port that cannot be opened is exit code 1, not 0; standard output holds the messages and nothing
else, log lines go to standard error.
Exit codes: 0 also after ^C; 1 the port cannot be opened.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import click

import yarpy
from yarpy.cli.output import print_json, print_line
from yarpy.cli.ports import ANY, hear_from, open_port
from yarpy.cli.shown import is_described, summary, text_of
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain

TRIM = 80


@dataclass(frozen=True)
class Intent:
    """The words behind the port's name, in any order."""

    remotes: list[str] = field(default_factory=list)
    envelope: bool = False
    trim: int = 0
    once: bool = False


def parse_words(words: Sequence[str]) -> Intent:
    """Read `[REMOTE...] [envelope] [trim [N]] [once]`."""
    remotes: list[str] = []
    found: dict[str, Any] = {}
    rest = list(words)
    while rest:
        word = rest.pop(0)
        if word in ("envelope", "once"):
            found[word] = True
        elif word == "trim":
            found["trim"] = int(rest.pop(0)) if rest and rest[0].isdigit() else TRIM
        else:
            remotes.append(word)
    return Intent(remotes, **found)


class Printer:
    """Prints messages the way the user wants them."""

    def __init__(self, envelope: bool = False, trim: int = 0, as_json: bool = False) -> None:
        self._envelope = envelope
        self._trim = trim
        self._json = as_json

    def show(self, message: yarpy.Message) -> bool:
        """Print `message`; False when it says that there will be no more."""

        value = _value(message)
        if isinstance(value, (yarpy.Sound, yarpy.PointCloud)):  # which are no lists
            self._print(message, value, summary(value))
            return True
        bottle = message.as_(yarpy.Bottle)
        verbatim = len(bottle) == 2 and type(bottle[0]) is int and type(bottle[1]) is str
        if verbatim and bottle[0] == 1:
            return False
        if verbatim:
            self._print(message, bottle[1], bottle[1])
        elif self._json:
            self._print(message, value if is_described(bottle) else bottle, "")
        else:
            self._print(message, bottle, text_of(message, bottle))
        return True

    def _print(self, message: yarpy.Message, value: Any, line: str) -> None:
        if self._json:
            source, envelope = message.source, message.envelope
            print_json({"source": source, "envelope": envelope, "value": value})
            return
        if self._envelope and message.envelope:
            print_line(f"{message.envelope} ")
        print_line(line[: self._trim] if self._trim else line)

    def follow(self, port: yarpy.BufferedPort, once: bool = False) -> None:
        """Print what arrives until the port closes or the messages say that they end."""

        for message in port:
            try:
                if not self.show(message):
                    return
            except yarpy.DecodeError as error:
                complain(f"a message from {message.source} cannot be printed: {error}")
            if once:
                return


def _value(message: yarpy.Message) -> Any:
    """Return what the message says that it is; None if it is no Bottle."""
    try:
        return message.value
    except yarpy.DecodeError:
        return None


@click.command()
@click.argument("port")
@click.argument("words", nargs=-1, metavar="[REMOTE]... [envelope] [trim [N]] [once]")
@click.option("--envelope", is_flag=True, help="Print envelopes, each on a line of its own.")
@click.option("--trim", type=int, metavar="N", help="Print only the first N characters.")
@click.option("--once", is_flag=True, help="End after one message.")
@click.option("--json", "as_json", is_flag=True, help="Print each message as a JSON object.")
@click.option(
    "--type", "port_type", default="", show_default=False,
    help="The type that the port says it takes.",
)  # fmt: skip
def command(
    port: str,
    words: tuple[str, ...],
    envelope: bool,
    trim: int | None,
    once: bool,
    as_json: bool,
    port_type: str,
) -> int:
    """Open PORT and print what arrives. Each REMOTE is asked to send to it.

    PORT may be `...`, any name that is free.
    """

    intent = parse_words(words)
    printer = Printer(envelope or intent.envelope, trim or intent.trim, as_json)
    try:
        with open_reader(port, port_type) as reader:
            for remote in intent.remotes:
                try:
                    hear_from(reader, remote)
                except (yarpy.AddressError, yarpy.UnknownPlugin):
                    raise  # it can never become right
                except yarpy.YarpError as error:
                    complain(str(error))
                    note = "waiting for whoever sends here, which this does: yarpy connect /PORT"
                    click.echo(f"{note} {reader.name}", err=True)
            try:
                printer.follow(reader, once or intent.once)
            except Interrupted:
                click.echo("Interrupting...", err=True)
    except Interrupted:
        pass  # while it opened or closed
    return 0


def open_reader(name: str, port_type: str = "") -> yarpy.BufferedPort:
    """A port that keeps every message. Raises AddressError with the hint that C++ gives."""

    try:
        return open_port(yarpy.BufferedPort, name, "-", strict=True, port_type=port_type)
    except yarpy.AddressError as error:
        if name == ANY or not name.startswith("/") or not yarpy.exists(name):
            raise
        raise yarpy.AddressError(
            f"{error}; to print what it sends: `yarpy read {ANY} {name}`"
        ) from error
