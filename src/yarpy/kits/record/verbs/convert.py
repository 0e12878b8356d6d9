"""`yarpy convert FILE... -o NAME`: write a recording in another way, or a part of it.

    yarpy convert walk.mcap -o walk_cpp --format dumper     for C++ yarpdataplayer
    yarpy convert walk_cpp -o walk                          and back
    yarpy convert walk.mcap -o short --start 10 --duration 5 --ports /icub/cam/left
    yarpy convert killed.mcap -o whole                      what could be read, as a finished file
    yarpy convert one.mcap two.mcap -o both --compress zstd
    yarpy convert drive.bag -o drive                        a bag of ROS 1, to the byte
    yarpy convert walk.mcap -o walk_bag --format bag2       for ros2 bag play

Exit codes: 0; 1 it cannot be read or written, or some of it is damaged.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain, warn

if TYPE_CHECKING:
    from yarpy.kits.record.recording import Recording


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("-o", "--output", "path", required=True, metavar="NAME",
              help="Write NAME.mcap, or the folder NAME.")  # fmt: skip
@click.option("--format", "format_", default="mcap", metavar="NAME",
              type=click.Choice(["mcap", "dumper", "bag1", "bag2"]),
              help="mcap, dumper (C++ yarpdatadumper), bag1, bag2 (of ROS 1, 2).")  # fmt: skip
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
def command(
    files: tuple[str, ...],
    path: str,
    format_: Literal["mcap", "dumper", "bag1", "bag2"],
    compression: str,
    times: Literal["", "rx", "tx", "tx+rx"],
    ports: str | None,
    start: float,
    duration: float | None,
) -> int:
    """Write FILEs, as one recording, in another way."""

    def chosen(recording: Recording) -> dict[str, Any]:
        return {
            "form": format_,
            "times": times,
            "ports": None if ports is None else [name for name in ports.split(",") if name],
            "start": start,
            "duration": duration,
        }

    return write_part(files, path, chosen, compression)


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
        damages = recording.damages
    for damage in damages:
        warn(damage)
    if done.left_out:
        form = arguments.get("form", "mcap")
        warn(f"{done.left_out} messages cannot be written as {form}, and were left out")
    print_line(f"{done.path}: {done.messages} messages")
    return 1 if damages else 0
