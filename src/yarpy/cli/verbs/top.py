"""`yarpy top [PATTERN]`: how every connection of the network is doing, live.

    top [PATTERN] [--sort rate|speed|drops|missed|latency|jitter|name] [--ports]
    top --json        a line of JSON for each look

PATTERN is a part of a name, or has wildcards (`/icub/*`). One connection to each port is kept and
asked once a second; where there are so many ports that asking takes longer, less often. On a
terminal keys sort, filter and show ports instead of connections; elsewhere a table is printed for
each look. Exit codes: 0; 1 no name server.
"""

from __future__ import annotations

import queue
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli.output import print_json, print_line
from yarpy.cli.screen import SORTS, View, matches, selected, text
from yarpy.cli.signals import Interrupted

if TYPE_CHECKING:
    from yarpy.network.sampling import Sampler
    from yarpy.network.traffic import Snapshot

PERIOD: Final = 1.0  # seconds between looks
SHARE: Final = 0.3  # of the time that may go into asking


@click.command()
@click.argument("pattern", default="")
@click.option("--sort", type=click.Choice(SORTS), default="rate", help="What comes first.")
@click.option("--ports", is_flag=True, help="Show ports instead of connections.")
@click.option("--json", "as_json", is_flag=True, help="Print a JSON object for each look.")
def command(pattern: str, sort: str, ports: bool, as_json: bool) -> int:
    """Show how every connection of the network is doing, live."""
    from yarpy.network.sampling import Sampler

    view = View(sort=sort, filter=pattern, ports=ports)
    with Sampler() as sampler:
        try:
            if sys.stdout.isatty() and not as_json:
                _live(sampler, view)
            else:
                for snapshot, _ in looks(sampler):
                    _print(snapshot, view, as_json)
        except Interrupted:
            pass  # how it ends
    return 0


def looks(
    sampler: Sampler, wait: Callable[[float], object] = time.sleep
) -> Iterator[tuple[Snapshot, float]]:
    """Looks without an end, each with the seconds that it took. `wait` passes the time between."""
    while True:
        started = time.monotonic()
        snapshot = sampler.look()
        took = time.monotonic() - started
        yield snapshot, took
        wait(max(PERIOD - took, took / SHARE - took, 0.0))


def _print(snapshot: Snapshot, view: View, as_json: bool) -> None:
    from yarpy.cli import overview

    if as_json:
        ports, connections = overview.ports_json(snapshot), overview.connections_json(snapshot)
        print_json(
            {
                "time": snapshot.time,
                "ports": [one for one in ports if matches(view.filter, one["name"])],
                "connections": [
                    one for one in connections if matches(view.filter, one["source"], one["target"])
                ],
            }
        )
        return
    rows, columns = selected(snapshot, view)
    for cells in overview.layout(rows, None, False, columns):
        print_line(overview.line(cells))
    print_line("")


def _live(sampler: Sampler, view: View) -> None:
    """Show it on a terminal, until `q`."""
    from rich.console import Console
    from rich.live import Live

    from yarpy.platform.keys import keys

    console = Console(highlight=False)
    with keys() as pressed, Live(console=console, auto_refresh=False, screen=True) as live:
        now: list[tuple[Snapshot, float]] = []

        def show() -> None:
            size = shutil.get_terminal_size((80, 24))
            snapshot, took = now[0]
            live.update(text(snapshot, view, size.columns, size.lines, took), refresh=True)

        def wait(seconds: float) -> None:
            until = time.monotonic() + seconds
            while not view.over and (view.paused or time.monotonic() < until):
                left = 0.5 if view.paused else until - time.monotonic()
                try:
                    view.press(pressed.get(timeout=max(min(left, 0.5), 0.0)))
                    show()
                except queue.Empty:
                    pass

        for look in looks(sampler, wait):
            now[:] = [look]
            show()
            if view.over:
                return
            wait(0.0)
