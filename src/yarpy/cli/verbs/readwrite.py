"""`yarpy readwrite IN OUT`: print what arrives at IN, send the lines of standard input from OUT.

`yarpy read IN` and `yarpy write OUT verbatim` in one process: two people can talk. Ends with the
input. Exit codes: 0; 1 a port cannot be opened, or after ^C.
"""

from __future__ import annotations

import threading

import click

import yarpy
from yarpy.cli import prompt
from yarpy.cli.ports import open_port
from yarpy.cli.signals import Interrupted
from yarpy.cli.verbs.read import Printer, open_reader
from yarpy.cli.verbs.write import feed
from yarpy.platform.console import is_unread


@click.command()
@click.argument("in_port", metavar="IN")
@click.argument("out_port", metavar="OUT")
def command(in_port: str, out_port: str) -> int:
    """Print what arrives at IN while lines of standard input are sent, verbatim, from OUT."""

    try:
        with (
            open_reader(in_port) as reader,
            open_port(yarpy.Port, out_port, callback=lambda message: None) as writer,
        ):
            threading.Thread(target=_print, args=(reader,), name="yarpy print", daemon=True).start()
            try:
                feed(writer, prompt.lines(history=f"write_{out_port}"), verbatim=True)
            except Interrupted:
                click.echo("Interrupting...", err=True)
                raise
    except Interrupted:
        return 1
    return 0


def _print(reader: yarpy.BufferedPort) -> None:
    try:
        Printer().follow(reader)
    except OSError as error:
        if not is_unread(error):
            raise  # else sending goes on
