"""`yarpy robot FILE`: open the devices of a robot, join them, and close them in order.

    yarpy robot icub.xml                    XML of yarprobotinterface, version 3
    yarpy robot icub.xml --check            say what in its files is odd, wrong or ignored
    yarpy robot icub.xml --show             say what each device gets, and from where
    yarpy robot icub.xml --side left        replaces parameters with extern-name="side"

^C, SIGTERM and `quit` at the port PREFIX/yarprobotinterface end it: the actions of interrupt1 and
shutdown are done, devices closed in reverse. The second and the third signal do those of interrupt2
and interrupt3 meanwhile; the fourth ends the program at once.

Exit codes: 0 it was ended; 1 the files have errors, or the robot did not start.
"""

from __future__ import annotations

import os
import signal
import threading
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli import log
from yarpy.cli.output import print_line
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain, warn
from yarpy.scope import Waiter

if TYPE_CHECKING:
    from yarpy.kits.launch.document.problem import Problem
    from yarpy.kits.launch.robot.description import Description
    from yarpy.kits.launch.robot.robot import Robot

_LAST: Final = 4  # the signal that ends the program at once


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("file", type=click.Path(path_type=Path))
@click.argument("given", nargs=-1, type=click.UNPROCESSED, metavar="[--KEY VALUE]...")
@click.option("--check", is_flag=True, help="Open nothing: say what is odd in the files.")
@click.option(
    "--show", is_flag=True, help="Open nothing: say what each device gets, and from where."
)
@click.option("--portprefix", metavar="P", help="Instead of that of the file.")
@click.option("--enable_tags", "--enable-tags", "enabled", default="", metavar="TAGS",
              show_default=False, help='Tags of includes, "(a b)".')  # fmt: skip
@click.option("--disable_tags", "--disable-tags", "disabled", default="", metavar="TAGS",
              show_default=False, help="Tags of includes that are left out.")  # fmt: skip
@click.option("--keep-going", is_flag=True, help="Run with the devices that could be opened.")
def command(
    file: Path,
    given: tuple[str, ...],
    check: bool,
    show: bool,
    portprefix: str | None,
    enabled: str,
    disabled: str,
    keep_going: bool,
) -> int:
    """Run the robot of FILE: open its devices, and do its actions."""
    from yarpy.config.command_line import parse_options
    from yarpy.config.resource import Search
    from yarpy.kits.launch.document.problem import Problem, Where
    from yarpy.kits.launch.robot.checking import unknown_types
    from yarpy.kits.launch.robot.merged import tags
    from yarpy.kits.launch.robot.robot_file import load

    values = parse_options(given)
    found = load(
        Search().find(str(file)) or file,
        given=values,
        portprefix=portprefix,
        enabled=tags(enabled),
        disabled=tags(disabled),
    )
    if show:
        from yarpy.kits.launch.robot.shown import lines

        for line in lines(found):
            print_line(line)
    problems = [*found.problems, *unknown_types(found)]
    if not (check or show or keep_going):  # nobody hands devices in here
        missing = found.missing()
        problems = [one for one in problems if one not in missing]
        problems += [replace(one, fatal=True) for one in missing]
    problems += [
        Problem(Where("command line"), f'no parameter has extern-name="{key}": it is ignored')
        for key in values
        if key not in found.taken
    ]
    if check:
        return _checked(found, problems)
    for problem in problems:
        (complain if problem.fatal else warn)(f"{problem.where}: {problem.text}")
    if show or any(problem.fatal for problem in problems):
        return 1 if any(problem.fatal for problem in problems) else 0
    return _run(found, keep_going)


def _checked(description: Description, problems: list[Problem]) -> int:
    for problem in problems:
        print_line(str(problem))
    many = len(problems)
    print_line(f"{description.summary}, {many or 'no'} problem{'' if many == 1 else 's'}")
    return 1 if any(problem.fatal for problem in problems) else 0


def _run(description: Description, keep_going: bool) -> int:
    import yarpy
    from yarpy.kits.launch.robot.robot import Robot
    from yarpy.kits.launch.robot.rpc import Answers, port_name
    from yarpy.registry import devices

    log.show()
    robot = Robot(description, devices.load, keep_going=keep_going, news=complain)
    over = Waiter()
    started = False
    with yarpy.RpcServer(port_name(description.portprefix), Answers(robot, over.wake)):
        try:
            started = robot.start()
            if started:
                states = [slot.state for slot in robot.slots.values()]
                print_line(
                    f"{description.name} runs: {states.count('open')} of {len(states)} devices"
                )
                over.wait()
        except Interrupted:
            started = True  # somebody wanted it to end
        _later(robot)
        robot.stop()
    return 0 if started else 1


def _later(robot: Robot) -> None:
    """Let the next signals do the actions of interrupt2 and interrupt3, and then end at once."""
    count = 1

    def again(number: int, frame: object) -> None:
        nonlocal count
        count += 1
        if count >= _LAST:
            os._exit(128 + number)
        phase = f"interrupt{count}"
        threading.Thread(target=robot.do, args=(phase,), name=f"yarpy {phase}", daemon=True).start()

    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), again)
