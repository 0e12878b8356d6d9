"""`yarpy stats [PORT]`: how every connection of the network is doing, or what one port sends.

    stats [--wide] [--json]          all connections, as their ports count them: carrier, rates,
                                     drops, latency, as much as the terminal has room for; --wide
                                     adds messages, jitter, granted priorities and monitors;
                                     `yarpy top` shows it live
    stats PORT [--duration S] ...    measure PORT by reading from it: a line each second, and the
                                     totals at the end, or when interrupted

Sizes are those of the payloads as they travel. C++ ports do not count; their columns are empty.
Exit codes: 0; 255 PORT cannot be connected.
"""

from __future__ import annotations

import shutil
import sys
import time
from dataclasses import dataclass, field
from typing import Any

import click

import yarpy
from yarpy.cli.output import print_all_json, print_json, print_line
from yarpy.cli.ports import ANY, hear_from, open_port
from yarpy.cli.signals import Interrupted
from yarpy.cli.stderr import complain

FAILED = 255


@dataclass(slots=True)
class Tally:
    """The messages that came since `started`."""

    started: float = field(default_factory=time.perf_counter)
    messages: int = 0
    bytes: int = 0

    def count(self, size: int) -> None:
        self.messages += 1
        self.bytes += size

    @property
    def period(self) -> float:
        """Mean seconds between messages, 0.0 if there are none."""
        passed = time.perf_counter() - self.started
        return passed / self.messages if self.messages else 0.0

    def line(self) -> str:
        """Return the rates of the time measured, in one line."""
        passed = max(time.perf_counter() - self.started, 1e-9)
        megabits = self.bytes * 8e-6 / passed
        rate = self.messages / passed
        return f"{megabits:.4g} Mb/s, {rate:.4g} btl/s, {self.period:.4g} mean period (s)"

    def total(self) -> str:
        """Return the totals of the time measured, in one line."""
        return (
            f"{self.bytes / 1e6:.6g} total MB received,  {self.messages} total bottles received, "
            f"{self.period:.4g} mean period (s)"
        )

    def as_dict(self) -> dict[str, Any]:
        """The same for JSON."""
        return {
            "seconds": time.perf_counter() - self.started,
            "messages": self.messages,
            "bytes": self.bytes,
            "period": self.period,
        }


def size_of(message: yarpy.Message) -> int:
    """Bytes of the payload; what travels as an object has none."""
    return len(message.payload) if message.spelling != "object" else 0


@click.command()
@click.argument("port", required=False)
@click.option("--wide", is_flag=True, help="Without PORT: all columns, however long the lines.")
@click.option(
    "--port_type", type=click.Choice(["BufferedPort", "Port"]), default="BufferedPort",
    help="Read all that comes (BufferedPort), or one by one while PORT waits (Port).",
)  # fmt: skip
@click.option("--duration", type=float, metavar="S", help="Seconds to measure.")
@click.option("--protocol", default="tcp", help="The carrier to read over.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON objects.")
def command(
    port: str | None,
    wide: bool,
    port_type: str,
    duration: float | None,
    protocol: str,
    as_json: bool,
) -> int:
    """Show how every connection is doing, or measure what PORT sends."""
    if port is None:
        return _show_all(as_json, wide)
    kind: Any = yarpy.Port if port_type == "Port" else yarpy.BufferedPort
    options: dict[str, Any] = {} if port_type == "Port" else {"strict": True}
    with open_port(kind, ANY, **options) as reader:
        try:
            hear_from(reader, port, protocol)
        except yarpy.YarpError as error:
            complain(f"Connection failed: {error}")
            return FAILED
        whole = Tally()
        end = None if duration is None else whole.started + duration
        try:
            _measure(reader, whole, end, as_json)
        except Interrupted:
            pass  # the totals are what it was run for
        print_json({"total": whole.as_dict()}) if as_json else print_line(whole.total())
    return 0


def _show_all(as_json: bool, wide: bool) -> int:
    """The command without PORT: the table of `yarpy top`, once."""
    from yarpy.cli import overview
    from yarpy.network.sampling import Sampler

    with Sampler() as sampler:
        snapshot = sampler.look()
    if as_json:
        print_all_json(overview.connections_json(snapshot))
        return 0
    rows = [overview.row(flow) for flow in overview.shown(snapshot, wide)]
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    for cells in overview.layout(rows, width, wide):
        print_line(overview.line(cells))
    return 0


def _measure(reader: Any, whole: Tally, end: float | None, as_json: bool) -> None:
    """Read until `end`, telling once a second."""
    while end is None or time.perf_counter() < end:
        second = Tally()
        until = second.started + 1.0 if end is None else min(second.started + 1.0, end)
        while (left := until - time.perf_counter()) > 0:
            try:
                size = size_of(reader.read(timeout=left))
            except yarpy.Timeout:
                continue  # some systems are a moment early
            second.count(size)
            whole.count(size)
        print_json(second.as_dict()) if as_json else print_line(second.line())
