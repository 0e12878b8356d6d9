"""`yarpy rpcserver [--single] [--stop] [--echo] PORT`: answer questions by hand.

Prints each message and reads a line, the reply. At the end of input replies are empty.

Differs from C++: a message whose sender waits for no reply is printed, and no line is read for it.
Exit codes: 0 with `--stop`; 1 the port cannot be opened, or after ^C.
"""

from __future__ import annotations

from collections.abc import Iterator

import click

import yarpy
from yarpy.cli import prompt, typed
from yarpy.cli.output import print_line
from yarpy.cli.ports import open_port
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain


@click.command()
@click.option("--single", is_flag=True, help="Close each connection after its first reply.")
@click.option("--stop", is_flag=True, help="End after one message.")
@click.option("--echo", is_flag=True, help="Reply with the message itself.")
@click.option(
    "--type", "port_type", default="", show_default=False,
    help="The type that the port says it takes.",
)  # fmt: skip
@click.argument("port")
def command(single: bool, stop: bool, echo: bool, port_type: str, port: str) -> int:
    """Print what PORT is asked, and reply with lines of standard input."""

    try:
        with open_port(yarpy.Port, port, "-1", port_type=port_type) as server:
            try:
                serve(server, single, stop, echo)
            except Interrupted:
                click.echo("Interrupting...", err=True)
                raise
    except Interrupted:
        return 1
    return 0


def serve(server: yarpy.Port, single: bool, stop: bool, echo: bool) -> None:
    """Answer until the port closes, or once."""
    answers = prompt.lines(prompt="")
    print_line("Waiting for a message...")
    for message in server:
        _answer(message, answers, echo)
        if single:
            for link in server.inputs:
                if link.source == message.source:
                    link.close()
        if stop:
            return
        print_line("Waiting for a message...")


def _answer(message: yarpy.Message, answers: Iterator[str], echo: bool) -> None:

    try:
        question = message.as_(yarpy.Bottle)
    except yarpy.DecodeError as error:
        complain(f"a message from {message.source} cannot be printed: {error}")
        question = yarpy.Bottle()
    print_line(f"Message: {question.to_text()}")
    if not message.wants_reply:
        return
    print_line("Reply: ")
    reply = question if echo else typed.bottle(next(answers, ""))
    try:
        message.reply(reply)
    except yarpy.LinkClosed as error:
        complain(f"{message.source} did not wait for the reply: {error}")
