"""`yarpy check`: try whether ports can be opened, found, connected, written and read here.

    FILE...                    what in files of applications and robots is ignored, or wrong
    --access                   who may do what with the ports of this computer (access.toml)
    --access WHO RIGHT PORT    whether somebody may do that, and why

Without a name server it tries the same within this process. Exit codes: 0 all went well, or it is
allowed; 1 not.
"""

from __future__ import annotations

from pathlib import Path

import click

import yarpy
from yarpy.cli import log
from yarpy.cli.output import print_line
from yarpy.registry import checks

LINE = "=" * 66
NUMBER = 42


@click.command()
@click.option("--access", is_flag=True, help="Tell who may do what with the ports here.")
@click.option("--offline", is_flag=True, help="Do not ask the name server (FILE).")
@click.argument("words", nargs=-1, metavar="[FILE...] [WHO RIGHT PORT]")
def command(access: bool, offline: bool, words: tuple[str, ...]) -> int:
    """Try whether ports work here, say what is odd in files, or who may do what with ports."""
    if access:
        return _tell_access(words)
    if words:
        files = tuple(map(Path, words))
        checking: click.Command = checks.load("check_file")
        code: int = click.get_current_context().invoke(checking, files=files, offline=offline)
        return code
    return _check()


def _tell_access(question: tuple[str, ...]) -> int:
    """Explain access.toml. Raises AddressError where there is a mistake in it."""
    from yarpy.cli.verbs.access import show
    from yarpy.config import access_file, access_report

    if len(question) not in (0, 3):
        raise click.UsageError(
            "ask for WHO RIGHT PORT, for example: --access 192.168.1.9 write /icubSim/head/rpc:i"
        )
    if not question:
        show()
        return 0
    allowed, lines = access_report.explained(access_file.current(), *question)
    for line in lines:
        print_line(line)
    return 0 if allowed else 1


def _check() -> int:
    from yarpy.cli.service import server

    _step("This is `yarpy check`", "It is a very simple sanity check for your installation")
    log.show()
    names: yarpy.YarpNameClient | yarpy.LocalNames
    try:
        names = server()
        alive = names.alive()
    except yarpy.YarpError:
        alive = False
    if not alive:
        _step("NO NAME SERVER!  Switching to local, fake mode")
        names = yarpy.LocalNames()
    try:
        _try(names)
    except yarpy.YarpError as error:
        print_line(f"*** {error}")
        print_line("*** YARP seems broken.")
        return 1
    if alive:
        print_line("*** YARP seems okay!")
    else:
        print_line("*** YARP seems okay, but there is no name server available.")
        print_line("    Start one: yarpy server    or find one: yarpy detect --write")
    return 0


def _try(names: object) -> None:
    """Raises YarpError, saying what does not work."""

    local = isinstance(names, yarpy.LocalNames)
    ends = ("/check/in", "/check/out") if local else ("...", "...")
    _step("Trying to register some ports")
    with (
        yarpy.BufferedPort(ends[0], strict=True, names=names) as reader,  # type: ignore[arg-type]
        yarpy.Port(ends[1], names=names) as writer,  # type: ignore[arg-type]
    ):
        _step("Trying to connect some ports")
        yarpy.connect(writer.name, reader.name, names=names)  # type: ignore[arg-type]
        _step("Trying to write some data")
        writer.write([NUMBER])
        _step("Trying to read some data")
        value = reader.read(timeout=5.0).value
        if value != [NUMBER]:
            raise yarpy.RemoteProtocolError(f"{NUMBER} was sent, {value} arrived")
        print_line(f"*** Read number {value[0]}")
        _step("Trying to close some ports")


def _step(*texts: str) -> None:
    print_line(LINE)
    for text in texts:
        print_line(f"=== {text}")
