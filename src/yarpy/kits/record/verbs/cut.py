"""`yarpy cut FILE -o NAME`: write a stretch of time of a recording.

    yarpy cut walk.mcap -o fall --from "it fell over" --duration 5

`yarpy convert` has all of the options of what is written.
Exit codes: 0; 1 it cannot be read or written, or some of it is damaged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.verbs.convert import write_part

if TYPE_CHECKING:
    from yarpy.kits.record.recording import Recording


@click.command()
@click.argument("file", metavar="FILE")
@click.option("-o", "--output", "path", required=True, metavar="NAME", help="Write NAME.mcap.")
@click.option("--start", type=click.FloatRange(0), default=0.0, metavar="S",
              help="Leave out the first S seconds.")  # fmt: skip
@click.option("--from", "mark", metavar="MARK", help="Begin at the mark with this note.")
@click.option("--duration", type=click.FloatRange(0, min_open=True), metavar="S",
              help="Write S seconds of it.")  # fmt: skip
@click.option("--to", "until", metavar="MARK", help="End at the mark with this note.")
@click.option("--compress", "compression", default="none", metavar="NAME",
              type=click.Choice(["none", "lz4", "zstd"]), help="none, lz4 or zstd.")  # fmt: skip
def command(
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

    return write_part([file], path, chosen, compression)
