"""`yarpy cut`, `merge`, `filter`: a stretch of time, several recordings as one, some of the ports.

    yarpy cut walk.mcap -o fall --from "it fell over" --duration 5
    yarpy merge left.mcap right.mcap -o both
    yarpy filter walk.mcap -o small -e ^/icub/ --exclude /cam/ --max-rate '*=10'

They write what `yarpy convert` writes, which has all of their options but those that choose.
Exit codes: 0; 1 it cannot be read or written, or some of it is damaged.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import click

from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain, warn
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.verbs.record import parse_rate

if TYPE_CHECKING:
    from yarpy.kits.record.recording import Recording

_output = click.option(
    "-o", "--output", "path", required=True, metavar="NAME", help="Write NAME.mcap."
)
_compress = click.option(
    "--compress", "compression", default="none", metavar="NAME",
    type=click.Choice(["none", "lz4", "zstd"]), help="none, lz4 or zstd.",
)  # fmt: skip


@click.command()
@click.argument("file", metavar="FILE")
@_output
@click.option("--start", type=click.FloatRange(0), default=0.0, metavar="S",
              help="Leave out the first S seconds.")  # fmt: skip
@click.option("--from", "mark", metavar="MARK", help="Begin at the mark with this note.")
@click.option("--duration", type=click.FloatRange(0, min_open=True), metavar="S",
              help="Write S seconds of it.")  # fmt: skip
@click.option("--to", "until", metavar="MARK", help="End at the mark with this note.")
@_compress
def cut(
    file: str,
    path: str,
    start: float,
    mark: str | None,
    duration: float | None,
    until: str | None,
    compression: str,
) -> int:
    """Write a stretch of time of FILE."""
    if duration is not None and until is not None:
        raise click.UsageError("--duration and --to both say where it ends")

    def chosen(recording: Recording) -> dict[str, Any]:
        begin = start if mark is None else start + recording.mark(mark)
        length = duration if until is None else recording.mark(until) - begin
        if length is not None and length <= 0:
            raise LocalProtocolError(f'the mark "{until}" is not behind the beginning')
        return {"start": begin, "duration": length}

    return written([file], path, chosen, compression)


@click.command()
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@_output
@_compress
def merge(files: tuple[str, ...], path: str, compression: str) -> int:
    """Write FILEs as one, in the order in which their messages were received."""
    return written(files, path, lambda recording: {}, compression)


@click.command(name="filter")
@click.argument("file", metavar="FILE")
@_output
@click.option("--ports", metavar="NAMES", help="These ports: /a,/b.")
@click.option("-e", "--regex", "pattern", default="", show_default=False, metavar="REGEX",
              help="... or those whose names contain a match.")  # fmt: skip
@click.option("--exclude", default="", show_default=False, metavar="REGEX",
              help="... but not those.")  # fmt: skip
@click.option("--kind", "kinds", multiple=True, metavar="KIND",
              help="Ports with messages of KIND: image, vector ...")  # fmt: skip
@click.option("--max-rate", "rates", multiple=True, metavar="PORT=N",
              help="Keep N messages a second of a port (/cam/*=10) at most.")  # fmt: skip
@_compress
def filter_(
    file: str,
    path: str,
    ports: str | None,
    pattern: str,
    exclude: str,
    kinds: tuple[str, ...],
    rates: tuple[str, ...],
    compression: str,
) -> int:
    """Write some of the ports of FILE."""
    from yarpy.kits.record.following import Wanted

    names = tuple(name for name in (ports or "").split(",") if name)
    wanted = Wanted(names, every=not (names or pattern), pattern=pattern, exclude=exclude)
    limits = dict(map(parse_rate, rates))

    def chosen(recording: Recording) -> dict[str, Any]:
        found = [*names]
        for name, facts in recording.ports.items():
            of_kind = not kinds or any(one.rpartition("/")[2] in kinds for one in facts.kinds)
            if name not in names and wanted.matches(name) and of_kind:
                found.append(name)
        if not found:
            raise LocalProtocolError(f"no port is left of {' '.join(recording.ports)}")
        return {"ports": found, "rates": limits}

    return written([file], path, chosen, compression)


def written(
    files: Sequence[str],
    path: str,
    chosen: Callable[[Recording], dict[str, Any]],
    compression: str,
) -> int:
    """Write what `chosen` says of a recording; return the exit code."""
    from yarpy.kits.record.convert import convert
    from yarpy.kits.record.recording import open_recording

    with open_recording(*files) as recording:
        try:
            done = convert(recording, path, compression=compression, **chosen(recording))
        except FileExistsError as error:
            complain(f"{error.filename} is there already: choose another name with -o")
            return 1
        damages = recording.damages
    for damage in damages:
        warn(damage)
    print_line(f"{done.path}: {done.messages} messages")
    return 1 if damages else 0
