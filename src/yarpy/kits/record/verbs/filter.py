"""`yarpy filter FILE -o NAME`: write some of the ports of a recording.

    yarpy filter walk.mcap -o small -e ^/icub/ --exclude /cam/ --max-rate '*=10'

`yarpy convert` has all of the options of what is written.
Exit codes: 0; 1 it cannot be read or written, or some of it is damaged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from yarpy.errors import LocalProtocolError
from yarpy.kits.record.verbs.convert import write_part
from yarpy.kits.record.verbs.record import parse_rate

if TYPE_CHECKING:
    from yarpy.kits.record.recording import Recording


@click.command()
@click.argument("file", metavar="FILE")
@click.option("-o", "--output", "path", required=True, metavar="NAME", help="Write NAME.mcap.")
@click.option("--ports", metavar="NAMES", help="These ports: /a,/b.")
@click.option("-e", "--regex", "pattern", default="", show_default=False, metavar="REGEX",
              help="... or those whose names contain a match.")  # fmt: skip
@click.option("--exclude", default="", show_default=False, metavar="REGEX",
              help="... but not those.")  # fmt: skip
@click.option("--kind", "kinds", multiple=True, metavar="KIND",
              help="Ports with messages of KIND: image, vector ...")  # fmt: skip
@click.option("--max-rate", "rates", multiple=True, metavar="PORT=N",
              help="Keep N messages a second of a port (/cam/*=10) at most.")  # fmt: skip
@click.option("--compress", "compression", default="none", metavar="NAME",
              type=click.Choice(["none", "lz4", "zstd"]), help="none, lz4 or zstd.")  # fmt: skip
def command(
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
    from yarpy.kits.record.capture.subscriptions import PortSelection

    names = tuple(name for name in (ports or "").split(",") if name)
    wanted = PortSelection(names, every=not (names or pattern), pattern=pattern, exclude=exclude)
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

    return write_part([file], path, chosen, compression)
