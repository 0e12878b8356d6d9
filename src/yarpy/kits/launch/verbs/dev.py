"""`yarpy dev --device TYPE [--KEY VALUE]...`: open a device, and serve it until it is to end.

    yarpy dev --device fakeFrameGrabber --name /cam --width 640
    yarpy dev --device controlBoard_nws_yarp --subdevice myArm --name /arm --period 0.02
    yarpy dev --from arm.ini                        options in a file, groups as [GENERAL]
    yarpy dev --list                                the types that are installed, and what they are;
                                                    what is plugged in

Rules: the options are those of C++ yarpdev. A device that comes without a server gets the one for
its kind. ^C and SIGTERM end it, and so does `quit` at the port NAME/quit (`yarpy terminate NAME`).

Exit codes: 0 it was ended; 1 it did not open.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

import click

import yarpy
from yarpy.cli import log
from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain, warn
from yarpy.scope import Waiter

if TYPE_CHECKING:
    from yarpy.kits.launch.robot.standalone import StandaloneDevice

_AGAIN: Final = 0.5  # seconds until a device that does not open is tried once more


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("given", nargs=-1, type=click.UNPROCESSED, metavar="[TYPE] [--KEY VALUE]...")
@click.option("--device", metavar="TYPE", help="What to open; a server, if there is a subdevice.")
@click.option("--subdevice", metavar="TYPE", help="What that server serves.")
@click.option("--name", metavar="/NAME", help="What its ports are called.")
@click.option("--from", "--file", "source", metavar="FILE", help="Options in a file.")
@click.option("--context", metavar="C", help="Where that file is looked for.")
@click.option("--nested", "--lispy", "nested", metavar="TEXT", help='"(device TYPE) (KEY VALUE)".')
@click.option("--list", "listed", is_flag=True, help="Print the types that can be opened.")
@click.option("--wait", type=float, default=0.0, metavar="S", help="Try for S seconds to open it.")
def command(
    given: tuple[str, ...],
    device: str | None,
    subdevice: str | None,
    name: str | None,
    source: str | None,
    context: str | None,
    nested: str | None,
    listed: bool,
    wait: float,
) -> int:
    """Open a device and serve it."""
    from yarpy.kits.launch.robot.standalone import types

    if given and not given[0].startswith("-"):
        if device is None:
            device = given[0]
            given = given[1:]
        else:
            raise click.UsageError(f'"{given[0]}" is no option: --KEY VALUE')
    named = {
        "device": device,
        "subdevice": subdevice,
        "name": name,
        "from": source,
        "context": context,
    }
    words = [word for key, value in named.items() if value for word in (f"--{key}", value)]
    options = yarpy.Property.from_text(nested or "")
    options.update(yarpy.ResourceFinder([*given, *words]).values)
    if listed or not options.get("device"):
        return _types()
    log.show()
    server, kind = types(options)
    for one in (server, kind):
        if one and (why := _unknown(one)):
            complain(why)
            return 1
    opened = _opened(options, wait)
    return 1 if opened is None else _run(opened)


def _types() -> int:
    """Print the types that are installed."""
    from yarpy.kits.devices.catalogue import lines
    from yarpy.kits.devices.hardware.plugged import plugged

    print_line("types of devices, for yarpy dev --device TYPE:")
    for one in lines():
        print_line(one)
    if found := plugged():
        print_line("plugged in here:")
        for one in found:
            print_line(f"  {one}")
    return 0


def _unknown(kind: str) -> str:
    """Return what is wrong with the name of a type, "" for nothing."""
    from yarpy.kits.launch.document.advice import advice
    from yarpy.registry import devices

    known = devices.names()
    if kind in known:
        return ""
    return (
        f'no device of type "{kind}" is installed{advice(kind, known) or ": see yarpy dev --list"}'
    )


def _opened(options: yarpy.Property, wait: float) -> StandaloneDevice | None:
    from yarpy.kits.devices.wrapper import server_of
    from yarpy.kits.launch.robot.standalone import StandaloneDevice
    from yarpy.registry import devices

    until = time.monotonic() + wait
    told = ""
    while True:
        try:
            return StandaloneDevice(options, devices.load, server_of)
        except Exception as error:  # whatever a driver raises
            why = f"{options['device']} does not open: {error or type(error).__name__}"
        left = until - time.monotonic()
        if left <= 0:
            complain(why)
            return None
        if why != told:
            warn(f"{why}; trying again")
            told = why
        time.sleep(min(left, _AGAIN))


def _run(opened: StandaloneDevice) -> int:
    over = Waiter()

    def answer(message: yarpy.Message) -> list[yarpy.Vocab]:
        words = message.as_(yarpy.Bottle)
        if not words or str(words[0]) != "quit":
            return [yarpy.Vocab("huh?")]
        over.wake()
        return [yarpy.Vocab("ok")]

    with opened, yarpy.RpcServer(f"{opened.name.rstrip('/')}/quit", answer):
        try:
            if opened.server:
                print_line(f"{opened.device} is served as {opened.name} ({opened.server})")
            else:
                print_line(f"{opened.device} is open")
            over.wait()
        except Interrupted:
            pass
    return 0
