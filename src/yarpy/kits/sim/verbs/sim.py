"""`yarpy sim`: a simulated robot on YARP ports, the head of an iCub, all of one, or a MuJoCo model.

    --robot NAME      the beginning of its ports' names (icubSim, or what the model is called)
    --fps HZ          pictures per second of its cameras (30)
    --size WxH        of its pictures, in pixels (320x240)
    --whole           torso, arms and legs too, the boards of a whole iCub
    --mujoco FILE     this model instead of the head: joints, cameras, sensors, lasers, a base; or a
                      folder with its scene.xml, as in MuJoCo Menagerie
    --ros             as a node of ROS 1 too: pictures, joint states, frames, a service that moves
                      joints
    --ros2            as a node of ROS 2 too: pictures, joint states, frames; over what
                      RMW_IMPLEMENTATION names, else over Zenoh, which needs `yarpy router`

Exit codes: 0 ended by a signal; 1 the names are in use, the file is no model, MuJoCo is missing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from yarpy.cli import log, signals
from yarpy.cli.output import print_line
from yarpy.cli.stderr import warn
from yarpy.platform import waiting
from yarpy.registry import robots

if TYPE_CHECKING:
    _Type = click.ParamType[tuple[int, int]]
else:
    _Type = click.ParamType  # older ones of click have no type parameter


class Size(_Type):
    """`320x240`: width and height in pixels."""

    name = "size"

    def convert(
        self, value: object, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int]:
        width, _, height = str(value).partition("x")
        if not (width.isdecimal() and height.isdecimal()):
            self.fail(f"{value!r} is no size; say 640x480", param, ctx)
        size = int(width), int(height)
        if not all(16 <= length <= 2048 for length in size):
            self.fail(f"{value}: from 16 to 2048 pixels, either way", param, ctx)
        return size


@click.command()
@click.option("--robot", "--name", metavar="NAME", help="Prefix of the ports (icubSim).")
@click.option(
    "--fps",
    type=click.FloatRange(0.1, 1000.0),
    default=30.0,
    metavar="HZ",
    help="Pictures per second.",
)
@click.option(
    "--size", type=Size(), default="320x240", metavar="WxH", help="Of the pictures, in pixels."
)
@click.option("--whole", is_flag=True, help="Torso, arms and legs too.")
@click.option(
    "--mujoco",
    "model",
    type=click.Path(exists=True),
    metavar="FILE",
    help="Simulate this MuJoCo model (XML, or its folder) instead.",
)
def command(
    robot: str | None,
    fps: float,
    size: tuple[int, int],
    whole: bool,
    model: str | None,
    **others: bool,
) -> int:
    """Simulate a robot: joints, cameras and sensors on YARP ports."""
    from yarpy.kits.sim.robot import NAME, Robot, icub, icub_head

    log.show()
    if whole and model is not None:
        raise click.UsageError("--whole is the iCub's: a model of --mujoco says itself what it has")
    if model is None:
        name, parts = NAME, (icub if whole else icub_head)(size)
    else:
        from yarpy.kits.sim.mujoco.robot import mujoco_robot

        try:
            name, parts = mujoco_robot(model, size, warn=warn)
        except ValueError as error:
            raise click.ClickException(str(error)) from error
    with signals.held():
        opened = Robot(robot or name, parts, fps)
        click.get_current_context().call_on_close(opened.close)
        for system in others:
            if others[system]:
                shown = robots.load(system)().show(opened)
                click.get_current_context().with_resource(shown)
    try:
        print_line(f"{opened.name} is ready: {' '.join(opened.ports)}")
        waiting.wait()
    except signals.Interrupted:
        pass
    return 0


for _system in robots.names():
    command.params.append(
        click.Option([f"--{_system}"], is_flag=True, help=f"Show the robot in {_system}, too.")
    )
