"""`yarpy log [PATTERN]`: what the programs of the network log, as it is logged.

    log                          of all programs that forward their log
    log PATTERN                  of those whose ports `/log/HOST/PROGRAM/PID` have that part, or
                                 match it (`/log/*/arm.py/*`)
    log --level WARNING          what is at least as bad
    log --program arm* --grep "joint [23]"
    log -o today.log -o today.mcap
    log --page -q                in a browser, with search and filters; this computer alone sees it

A program of yarpy or C++ YARP forwards its log if YARP_FORWARD_LOG_ENABLE=1 is in its environment;
so do those that `yarpy run --log` starts. This command is /yarplogger, to which such programs
connect by themselves, unless somebody else is; others are looked for every second. Those of yarpy
tell their last thousand lines to whoever comes late. What comes faster than it is shown waits; what
is lost is counted. Exit codes: 0 when interrupted, or done; 1 no name server.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import click

import yarpy
from yarpy.cli.output import jsonable
from yarpy.cli.ports import ANY, open_another, open_port
from yarpy.cli.signals import Interrupted, held
from yarpy.cli.stderr import warn
from yarpy.limit import LOG_MESSAGE
from yarpy.log import readable
from yarpy.port.keep.log_line import LEVELS
from yarpy.port.keep.log_sender import LOGGER
from yarpy.transports.bind import SETTING

if TYPE_CHECKING:
    from yarpy.kits.launch.log.collector import LogCollector
    from yarpy.kits.launch.log.log_file import LogFile
    from yarpy.kits.launch.page.log_page import LogPage
    from yarpy.port.keep.log_line import LogLine

PAGE: Final = "/logger"  # the port that serves the page
ENDING: Final = 1.0  # seconds for what has come when it is interrupted
QUIET: Final = 1.5  # seconds without a line, after which --no-follow ends


@click.command()
@click.argument("pattern", default="")
@click.option("--level", type=click.Choice(LEVELS, case_sensitive=False), default="TRACE",
              help="Show what is at least as bad.")  # fmt: skip
@click.option("--program", default="", show_default=False, metavar="NAME",
              help="Show what programs say whose names have that part, or match it.")  # fmt: skip
@click.option("--component", default="", show_default=False, metavar="NAME",
              help="... components ...")  # fmt: skip
@click.option("--grep", default="", show_default=False, metavar="REGEX",
              help="Show lines whose text contains a match.")  # fmt: skip
@click.option("--json", "as_json", is_flag=True, help="Print an object for each line.")
@click.option("-o", "--output", "paths", multiple=True, metavar="FILE",
              help="Keep what is shown in FILE: .log, .txt, .json or .mcap.")  # fmt: skip
@click.option("-q", "--quiet", is_flag=True, help="Print nothing.")
@click.option("--page", is_flag=True, help="Show all of it in a browser, too.")
@click.option("--no-follow", is_flag=True, help="End when programs have told what they kept.")
@click.option("--name", default="", show_default=False, metavar="PORT",
              help="Be that port instead of /yarplogger.")  # fmt: skip
@click.option("--colour/--no-colour", default=None, help="At a terminal it is coloured anyway.")
def command(
    pattern: str,
    level: str,
    program: str,
    component: str,
    grep: str,
    as_json: bool,
    paths: tuple[str, ...],
    quiet: bool,
    page: bool,
    no_follow: bool,
    name: str,
    colour: bool | None,
) -> int:
    """Show what the programs of the network log, and keep it."""
    from yarpy.kits.launch.log.collector import LogCollector
    from yarpy.kits.launch.log.filter import Filter, expression
    from yarpy.kits.launch.log.log_file import open_log_file

    wanted = Filter(level, program, component, expression(grep))
    with ExitStack() as open_:
        files = []
        for path in paths:
            files.append(open_log_file(path))
            open_.callback(files[-1].close)
        shown = _page(open_) if page else None
        collector = LogCollector(partial(_open, name), pattern)
        open_.callback(collector.close)
        screen = _Screen(as_json, _coloured(colour))
        lost = 0

        def show() -> bool:
            nonlocal lost
            pairs = collector.read(0.0)
            lost = _tell_lost(collector, lost)
            if shown is not None:
                shown.lost = lost
                shown.add([line for line, _ in pairs])
            taken = [pair for pair in pairs if wanted.takes(pair[0])]
            if not quiet:
                screen.show([line for line, _ in taken])
            _keep(files, taken)
            return bool(pairs)

        try:
            while True:
                with held():  # what is shown is in the files, too
                    some = show()
                news = some or collector.wait(QUIET if no_follow else None)
                if collector.over or (not news and collector.joined):
                    break
        except Interrupted:
            until = time.monotonic() + ENDING
            while show() and time.monotonic() < until:
                pass
            if collector.waiting:
                warn(f"{collector.waiting} lines were not shown any more")
    return 0


def _open(name: str, hear: Callable[[yarpy.Message], None]) -> yarpy.Port:
    """The port that programs connect to by themselves, or another one if somebody has that."""
    try:
        return open_port(yarpy.Port, name or LOGGER, callback=hear, limit=LOG_MESSAGE)
    except yarpy.AddressError:
        if name:
            raise
        return open_port(yarpy.Port, ANY, callback=hear, limit=LOG_MESSAGE)


def _page(open_: ExitStack) -> LogPage:
    """The page, at a port that this computer alone reaches, whatever the one for programs is."""
    from yarpy.cli.browser import show_page
    from yarpy.kits.launch.page.log_page import LogPage

    before = os.environ.get(SETTING)
    os.environ[SETTING] = "local"  # ports read it when they open
    try:
        port = open_.enter_context(open_another(yarpy.Port, PAGE, callback=lambda message: None))
    finally:
        if before is None:
            del os.environ[SETTING]
        else:
            os.environ[SETTING] = before
    shown = LogPage(port)
    show_page(port)
    return shown


def _tell_lost(collector: LogCollector, before: int) -> int:
    lost = collector.lost
    if lost > before:
        warn(f"{lost - before} lines are lost: they came faster than they were shown")
    return lost


def _keep(files: list[LogFile], pairs: list[Any]) -> None:
    for file in files:
        for line, message in pairs:
            file.add(line, message)
        file.flush()


def _coloured(asked: bool | None) -> bool:
    from yarpy.config.configuration import flag

    if asked is not None:
        return asked
    return flag(os.environ, "YARP_COLORED_OUTPUT", sys.stdout is not None and sys.stdout.isatty())


class _Screen:
    """Standard output, which gets many lines at a time."""

    def __init__(self, as_json: bool, coloured: bool) -> None:
        self._as_json, self._coloured = as_json, coloured

    def show(self, lines: list[LogLine]) -> None:
        """Print lines; the reader of a pipe sees them at once."""
        import json

        from yarpy.kits.launch.log.shown import text_of, told_of

        out = sys.stdout
        if out is None or not lines:
            return
        if self._as_json:
            texts = [json.dumps(jsonable(told_of(line)), ensure_ascii=False) for line in lines]
        else:
            texts = [text_of(line, self._coloured) for line in lines]
        if self._as_json and out.isatty():
            texts = [readable(text) for text in texts]
        out.write("\n".join(texts) + "\n")
        out.flush()
