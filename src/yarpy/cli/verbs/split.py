"""`yarpy split PORT [--carrier C]`: send each element of PORT's messages to a port of its own.

The first element leaves from PORT/split0:o, the second from PORT/split1:o ...; an element that is
no list becomes a message of one element. Ports open when the first message comes, and more when a
longer one does. Runs until interrupted. Exit codes: 255 PORT cannot be connected.
"""

from __future__ import annotations

from typing import Any

import click

import yarpy
from yarpy.cli.output import print_line
from yarpy.cli.ports import ANY, hear_from, open_port
from yarpy.cli.stderr import complain

FAILED = 255


def part(element: Any) -> Any:
    """Return an element as it is sent."""

    return element if isinstance(element, list) else yarpy.Bottle([element])


@click.command()
@click.argument("port")
@click.option("--carrier", default="udp", help="How PORT is connected.")
def command(port: str, carrier: str) -> int:
    """Send each element of the messages of PORT to a port of its own."""

    outputs: list[yarpy.Port] = []
    with open_port(yarpy.BufferedPort, ANY, strict=True) as reader:
        try:
            hear_from(reader, port, carrier)
        except yarpy.YarpError as error:
            complain(f"Failed to connect: {error}")
            return FAILED
        try:
            for message in reader:
                elements = message.as_(yarpy.Bottle)
                while len(outputs) < len(elements):
                    name = f"{port}/split{len(outputs)}:o"
                    outputs.append(open_port(yarpy.Port, name, callback=lambda message: None))
                    print_line(f"Output goes to {name}")
                for element, output in zip(elements, outputs, strict=False):
                    output.write(part(element), message.envelope or None)
        finally:
            for output in outputs:
                output.close()
    return 0
