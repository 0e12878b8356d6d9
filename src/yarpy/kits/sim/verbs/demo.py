"""`yarpy demo`: a name server, a simulated robot, and a page that shows and moves it.

    --seconds N    end by itself
    --no-browser   open no browser
    --lan          let the other computers of this network see and move the robot too

It prints what to try, with curl, with netcat, with yarpy, with C++ YARP, and with ROS where a
master, or a router of Zenoh for ROS 2, answers on this computer (with --lan: anywhere). The numbers
of its ports are 10000 (or YARP_PORT_RANGE) and those behind it, or any free ones if somebody has
those. Nothing is written to the configuration.
Exit code: 0.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from typing import TYPE_CHECKING, Final

import click

import yarpy
from yarpy.cli import log, signals
from yarpy.cli.browser import open_page, url_of
from yarpy.cli.output import print_line
from yarpy.config.configuration import default_port
from yarpy.platform import waiting
from yarpy.platform.shell import quoted, setting

if TYPE_CHECKING:
    from yarpy.kits.sim.robot import Robot
    from yarpy.kits.sim.robot_publisher import RobotPublisher

TRY: Final = """
{robot} is a simulated robot: a head, two cameras, an inertial unit.

  {page}    <- open this: see what it sees, drag its joints{phone}

Its ports speak many protocols, all at the same address. In another terminal, without any YARP:

  curl {query}
  curl {move}
  curl {encoders}
{netcat}
With yarpy:

  {setting}
  {yarpy} name list
  echo get encs | {yarpy} rpc {robot}/head/rpc:i
  {yarpy} read ... {robot}/inertial/measures:o once
  {yarpy} view --connect {robot}/cam/left
  {yarpy} scope {robot}/head/state:o

With C++ YARP, after `yarp conf {where}`:

  yarp rpc {robot}/head/rpc:i
  yarp connect {robot}/cam/left /view        (to a yarpview)
  yarpmotorgui --robot {bare} --parts "(head)"

In a C++ program: device remote_controlboard, remote {robot}/head, local /client.
{elsewhere}Ctrl-C ends it all.
"""
NETCAT: Final = """\
  {{ echo CONNECT me; echo d; echo set pos 1 0; sleep 1; echo d; echo get encs; echo q; }} | nc {nc}
  echo hello there | nc {nc}      # no protocol: see what strangers are told
"""


@click.command()
@click.option("--seconds", type=click.FloatRange(min=0.0), metavar="N", help="End by itself.")
@click.option("--no-browser", is_flag=True, help="Open no browser.")
@click.option("--lan", is_flag=True, help="Let other computers see and move the robot too.")
def command(seconds: float | None, no_browser: bool, lan: bool) -> int:
    """Show what yarpy does: a simulated robot, in a browser and everywhere else."""
    from yarpy.kits.sim.robot import NAME, Robot, icub_head
    from yarpy.kits.views.panel import Panel
    from yarpy.transports.bind import SETTING

    log.show(logging.WARNING)
    if not lan:
        os.environ.setdefault(SETTING, "local")
    try:
        with (
            _name_server() as server,
            Robot(NAME, icub_head(), names=server.client) as robot,
            ExitStack() as shown,
            _page(server) as page,
        ):
            Panel(page, robot.name, server.client)
            elsewhere = "".join(_shown(robot, lan, shown))
            print_line(_advice(server, robot, page, elsewhere))
            if not no_browser:
                open_page(url_of(page.address))
            waiting.wait(seconds)
    except signals.Interrupted:
        pass
    print_line("The demo ends.")
    return 0


def _name_server() -> yarpy.NameServer:
    with signals.held():
        try:
            return yarpy.NameServer(default_port(os.environ))
        except yarpy.AddressError:
            return yarpy.NameServer()


def _page(server: yarpy.NameServer) -> yarpy.Port:
    """The port that serves the page; messages to it are taken and forgotten."""

    def forget(message: yarpy.Message) -> None:
        pass

    for number in (server.port + 1, 0):
        try:
            return yarpy.Port("/demo", callback=forget, names=server.client, tcp_port=number)
        except yarpy.AddressError:
            if not number:
                raise
    raise AssertionError("unreachable")


def _shown(robot: Robot, everywhere: bool, shown: ExitStack) -> Iterator[str]:
    """Show the robot in every other graph that is there, and yield what to try in it."""
    from yarpy import registry

    for system in registry.robots.names():
        publisher: RobotPublisher = registry.robots.load(system)()
        where = publisher.find(everywhere)
        if where:
            shown.enter_context(publisher.show(robot, where))
            yield publisher.advice(robot.name, where)


def _advice(server: yarpy.NameServer, robot: Robot, page: yarpy.Port, elsewhere: str) -> str:
    from yarpy.names.address import is_loopback, outward_address
    from yarpy.transports.bind import listening_host

    rpc = server.client.query(f"{robot.name}/head/rpc:i")
    assert rpc is not None
    outward = outward_address()
    phone = f"\n  {url_of(f'{outward}:{page.contact.port}')}    <- from a phone in the same network"
    return TRY.format(
        robot=robot.name,
        bare=robot.name.strip("/"),
        page=url_of(page.address),
        phone="" if is_loopback(outward) or listening_host() else phone,
        query=quoted(f"http://{server.address}/?req=query+$port&port={robot.name}/head/rpc:i"),
        move=quoted(f"http://{rpc.address}/?req=set+pos+$axis+$angle&axis=1&angle=45"),
        encoders=quoted(f"http://{rpc.address}/?req=get+encs"),
        netcat="" if sys.platform == "win32" else NETCAT.format(nc=rpc.address.replace(":", " ")),
        setting=setting("YARPY_SERVER", server.address),
        where=server.address.replace(":", " "),
        yarpy=_own_name(),
        elsewhere=elsewhere,
    )


def _own_name() -> str:
    """Return the command by which this program is called from the current folder."""
    import shutil

    beside = shutil.which("yarpy", path=os.path.dirname(sys.executable))
    found = shutil.which("yarpy")
    if beside is None:
        return "python -m yarpy"
    if found is not None and os.path.realpath(found) == os.path.realpath(beside):
        return "yarpy"
    here, place = os.path.realpath(os.curdir), os.path.realpath(os.path.dirname(beside))
    if place.startswith(here + os.sep):
        return os.path.relpath(beside)
    return beside
