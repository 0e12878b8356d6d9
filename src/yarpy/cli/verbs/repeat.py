"""`yarpy repeat PORT`: send on to PORT's outputs what arrives at PORT, until interrupted.

Messages of any type go through as they came, envelope included.
"""

from __future__ import annotations

import threading

import click

import yarpy
from yarpy.cli.ports import open_port
from yarpy.cli.relay import forwardable
from yarpy.platform import waiting


@click.command()
@click.argument("port")
def command(port: str) -> None:
    """Send on what arrives at PORT."""

    ready = threading.Event()

    def send_on(message: yarpy.Message) -> None:
        ready.wait()
        repeater.write(forwardable(message), message.envelope or None)

    with open_port(yarpy.Port, port, callback=send_on) as repeater:
        ready.set()
        waiting.wait()
