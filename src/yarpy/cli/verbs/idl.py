"""`yarpy idl`: types of other systems, such as messages of ROS and interfaces of Thrift.

Rules: each language has a command of its own, found by name (registry kind `idl_commands`, the
entry point group `yarpy.idl_commands`); this file knows none of them.
"""

from __future__ import annotations

import click

from yarpy.registry import idl_commands


class Languages(click.Group):
    """The commands of the languages, loaded when they are asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted(idl_commands.names())

    def get_command(self, ctx: click.Context, name: str) -> click.Command | None:
        if name not in idl_commands.names():
            return None
        command: click.Command = idl_commands.load(name)
        return command


@click.group(cls=Languages)
def command() -> None:
    """Types of other systems: show them, write code for them."""
