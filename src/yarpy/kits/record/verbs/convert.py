"""`yarpy convert FILE... -o NAME`: write a recording in another way, or a part of it.

    yarpy convert walk.mcap -o walk_cpp --format dumper     for C++ yarpdataplayer
    yarpy convert walk_cpp -o walk                          and back
    yarpy convert walk.mcap -o short --start 10 --duration 5 --ports /icub/cam/left
    yarpy convert killed.mcap -o whole                      what could be read, as a finished file
    yarpy convert one.mcap two.mcap -o both --compress zstd
    yarpy convert drive.bag -o drive                        a bag of ROS 1, to the byte
    yarpy convert walk.mcap -o walk_bag --format bag2       for ros2 bag play
    yarpy convert walk.mcap -o walk --format robometry      a .mat for MATLAB, and its .json
    yarpy convert 1.mcap 2.mcap -o reach --format lerobot --state /arm/state:o --action /goal:o
                                                            an episode of each file

Exit codes: 0; 1 it cannot be read or written, or some of it is damaged.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain, warn
from yarpy.errors import LocalProtocolError, YarpError

if TYPE_CHECKING:
    from yarpy.kits.record.recording import Recording


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("-o", "--output", "path", required=True, metavar="NAME",
              help="Write NAME.mcap, or the folder NAME.")  # fmt: skip
@click.option("--format", "format_", default="mcap", metavar="NAME",
              type=click.Choice(["mcap", "dumper", "bag1", "bag2", "robometry", "lerobot"]),
              help="mcap, dumper (of C++), bag1, bag2 (of ROS), robometry, lerobot.")  # fmt: skip
@click.option("--compress", "compression", default="none", metavar="NAME",
              type=click.Choice(["none", "lz4", "zstd"]), help="none, lz4 or zstd.")  # fmt: skip
@click.option("--times", default="", show_default=False, metavar="NAME",
              type=click.Choice(["", "rx", "tx", "tx+rx"]),
              help="Of the folders: rx, tx, tx+rx (--rxTime, --txTime in C++).")  # fmt: skip
@click.option("--ports", metavar="NAMES", help="Only these ports: /a,/b.")
@click.option("--start", type=click.FloatRange(0), default=0.0, metavar="S",
              help="Leave out the first S seconds.")  # fmt: skip
@click.option("--duration", type=click.FloatRange(0, min_open=True), metavar="S",
              help="Write S seconds of it.")  # fmt: skip
@click.option("--state", "states", multiple=True, metavar="PORT",
              help="A part of the state in a data set of LeRobot; again for another.")  # fmt: skip
@click.option("--action", "actions", multiple=True, metavar="PORT",
              help="A part of the action there.")  # fmt: skip
@click.option("--image", "images", multiple=True, metavar="PORT=NAME",
              help="Pictures there, and their name.")  # fmt: skip
@click.option("--fps", type=click.IntRange(1, 1000), default=30, show_default=True, metavar="N",
              help="Frames a second there.")  # fmt: skip
@click.option("--task", default="", show_default=False, metavar="TEXT",
              help="What the robot does there, as a sentence.")  # fmt: skip
def command(
    files: tuple[str, ...],
    path: str,
    format_: str,
    compression: str,
    times: Literal["", "rx", "tx", "tx+rx"],
    ports: str | None,
    start: float,
    duration: float | None,
    states: tuple[str, ...],
    actions: tuple[str, ...],
    images: tuple[str, ...],
    fps: int,
    task: str,
) -> int:
    """Write FILEs, as one recording, in another way."""
    if format_ == "lerobot":
        if ports is not None or start or duration is not None or times or compression != "none":
            raise LocalProtocolError(
                "a data set of LeRobot has its own: --state --action --image --fps --task; "
                "`yarpy cut` shortens an episode before"
            )
        return write_dataset(files, path, states, actions, images, fps, task)

    def chosen(recording: Recording) -> dict[str, Any]:
        return {
            "form": format_,
            "times": times,
            "ports": None if ports is None else [name for name in ports.split(",") if name],
            "start": start,
            "duration": duration,
        }

    return write_part(files, path, chosen, compression)


def write_dataset(
    files: Sequence[str],
    path: str,
    states: Sequence[str],
    actions: Sequence[str],
    images: Sequence[str],
    fps: int,
    task: str,
) -> int:
    """Write a data set of LeRobot, an episode of each file; return the exit code."""
    from yarpy.kits.record.lerobot.dataset import Plan, export

    plan = Plan(states, actions, dict(map(parse_image, images)), fps, task)
    try:
        count = export(files, Path(path), plan)
    except FileExistsError as error:
        complain(f"{error.filename} is there already: choose another name with -o")
        return 1
    except OSError as error:
        if isinstance(error, YarpError) or error.filename:
            raise
        raise LocalProtocolError(f"{path} cannot be written: {error}") from error
    print_line(f"{path}: {len(files)} episodes, {count} frames")
    return 0


def parse_image(text: str) -> tuple[str, str]:
    """Return the name of pictures, and their port, of `/cam/left=left`. Raises
    LocalProtocolError."""
    port, equals, name = text.partition("=")
    if not (equals and name and port.startswith("/")):
        raise LocalProtocolError(f'"{text}" names no pictures: --image /cam/left=left')
    return name, port


def write_part(
    files: Sequence[str],
    path: str,
    chosen: Callable[[Recording], dict[str, Any]],
    compression: str,
) -> int:
    """Write what `chosen` says of a recording, as arguments of `convert`; return the exit code."""
    from yarpy.kits.record.convert import convert
    from yarpy.kits.record.recording import open_recording

    with open_recording(*files) as recording:
        arguments = chosen(recording)
        try:
            done = convert(recording, path, compression=compression, **arguments)
        except FileExistsError as error:
            complain(f"{error.filename} is there already: choose another name with -o")
            return 1
        except OSError as error:
            error.filename = error.filename or path  # a full disk has no name
            raise
        damages = recording.damages
    for damage in damages:
        warn(damage)
    if done.left_out:
        form = arguments.get("form", "mcap")
        warn(f"{done.left_out} messages cannot be written as {form}, and were left out")
    print_line(f"{done.path}: {done.messages} messages")
    return 1 if damages else 0
