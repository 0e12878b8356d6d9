"""`yarpy idl sniff PORT`: a .msg file for what a port sends.

Exit codes: 0 written; 1 what comes cannot be a message of ROS.
"""

from __future__ import annotations

import click

from yarpy.cli.output import print_line


@click.command(short_help="Write a .msg file for what PORT sends.")
@click.argument("port")
@click.option("--count", default=1, help="Messages to look at; they must have one structure.")
def command(port: str, count: int) -> int:
    """Write a .msg file for what PORT sends, so that ROS can read its bytes unchanged."""
    import yarpy
    from yarpy.cli.ports import ANY, hear_from, open_port
    from yarpy.peers.ros.message.sniff import sniff as write

    with open_port(yarpy.BufferedPort, ANY, strict=True) as reader:
        hear_from(reader, port)
        samples = [bytes(reader.read().to_bytes()) for _ in range(max(count, 1))]
    print_line(write(*samples).rstrip("\n"))
    return 0
