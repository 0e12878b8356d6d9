"""The command line, and a name server that it uses."""

from support.commands import cli, here, lone, names, server

__all__ = ["cli", "here", "lone", "names", "server"]
