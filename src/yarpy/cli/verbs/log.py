"""`yarpy log [PATTERN]`: what the programs of the network log, as it is logged.

    log                  of all programs that forward their log
    log PATTERN          of those whose ports `/log/HOST/PROGRAM/PID` have that part, or match it
                         (`/log/*/arm.py/*`)
    log --level WARNING  what is at least as bad

A program of yarpy or C++ YARP forwards its log if YARP_FORWARD_LOG_ENABLE=1 is in its environment.
This command is /yarplogger, to which such programs connect by themselves, unless somebody else is;
others are looked for every second. Those of yarpy tell their last thousand lines to whoever comes
late. Exit codes: 0 when interrupted; 1 no name server.
"""

from __future__ import annotations

import threading
import time
from contextlib import suppress
from typing import Final

import click

import yarpy
from yarpy.cli.output import print_json, print_line
from yarpy.cli.ports import ANY, open_port
from yarpy.cli.signals import Interrupted
from yarpy.log import readable
from yarpy.port.log_line import LEVELS, LogLine, read_line

PARTS: Final = ("/log/", "/yarprunlog/")  # of the names of ports that log
ORIGINS: Final = 10_000  # programs of which it is known what came last
PERIOD: Final = 1.0  # seconds between looks for more of them


@click.command()
@click.argument("pattern", default="")
@click.option(
    "--level",
    type=click.Choice(LEVELS, case_sensitive=False),
    default="TRACE",
    help="Show what is at least as bad.",
)
@click.option("--json", "as_json", is_flag=True, help="Print an object for each line.")
def command(pattern: str, level: str, as_json: bool) -> int:
    """Show what the programs of the network log."""
    from yarpy.cli.screen import matches

    least = LEVELS.index(level)
    port = _open()
    done = threading.Event()
    thread = threading.Thread(target=_join, args=(port, pattern, done), daemon=True)
    thread.start()
    newest: dict[str, tuple[float, str]] = {}  # what came again with a new connection is no news
    try:
        for message in port:
            try:
                line = read_line(message.value, message.source)
            except yarpy.DecodeError:
                continue
            if line is None or not matches(pattern, line.origin):
                continue
            last = newest.get(line.origin, (0.0, ""))
            if line.time and (line.time < last[0] or (line.time, line.text) == last):
                continue
            newest[line.origin] = line.time, line.text
            if len(newest) > ORIGINS:  # strangers may make up any number
                del newest[next(iter(newest))]
            if line.level and LEVELS.index(line.level) < least:
                continue
            _print(line, as_json)
    except Interrupted:
        pass
    finally:
        done.set()
        thread.join()
    return 0


def _open() -> yarpy.BufferedPort:
    """The port that programs connect to by themselves, or another one if somebody has that."""
    from yarpy.port.log_forwarding import LOGGER

    try:
        return open_port(yarpy.BufferedPort, LOGGER, strict=True)
    except yarpy.AddressError:
        return open_port(yarpy.BufferedPort, ANY, strict=True)


def _join(port: yarpy.BufferedPort, pattern: str, done: threading.Event) -> None:
    """Ask all that log to send here, until `done`."""
    from yarpy.cli.screen import matches
    from yarpy.names.default import DEFAULT

    while True:
        known = {link.source for link in port.inputs}
        try:
            found = [one.name for one in DEFAULT.current().list()]
        except yarpy.YarpError:
            found = []
        for name in found:
            logs = any(part in name for part in PARTS) and matches(pattern, name)
            if logs and name not in known:
                with suppress(yarpy.YarpError):  # its program is gone, or not ours to ask
                    yarpy.connect(name, port.name)
        if done.wait(PERIOD):
            return


def _print(line: LogLine, as_json: bool) -> None:
    if as_json:
        print_json(
            {
                "port": line.origin,
                "level": line.level,
                "time": line.time,
                "component": line.component,
                "message": line.text,
                **{key: value for key, value in line.more.items() if key not in ("port", "time")},
            }
        )
        return
    clock = time.strftime("%H:%M:%S", time.localtime(line.time)) if line.time else "--:--:--"
    component = f"|{line.component}| " if line.component else ""
    text = f"{line.origin.removeprefix('/log/')} [{line.level or '?'}] {component}{line.text}"
    print_line(f"{clock} {readable(text)}")
    trace = line.more.get("backtrace")
    if isinstance(trace, str):
        for each in trace.splitlines():
            print_line(f"    {readable(each)}")
