"""`yarpy ping PORT`: what a port says of itself and its connections.

    ping PORT          its own description
    ping --time PORT   how long it takes to connect to it and get an answer
    ping --rate PORT   how often it sends

Differs from C++: ports that are not registered as `tcp` are asked like all others; `--rate`
returns 0 when messages came, and `--time` numbers its rounds from 1.
Exit codes: 0 it answered; 1 it did not.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from itertools import pairwise
from statistics import fmean, pstdev
from typing import Any

import click

import yarpy
from yarpy.cli.output import print_json, print_line

ROUNDS = 10


@click.command()
@click.argument("port")
@click.option("--time", "timed", is_flag=True, help="Measure the time of connecting.")
@click.option("--rate", is_flag=True, help="Measure the rate of what PORT sends.")
@click.option("--duration", default=5.0, metavar="S", help="Seconds for --rate.")
@click.option("--json", "as_json", is_flag=True, help="Print the answer as a JSON object.")
def command(port: str, timed: bool, rate: bool, duration: float, as_json: bool) -> int:
    """Ask PORT about itself and its connections."""
    if timed:
        return _measure_time(port, as_json)
    if rate:
        return _measure_rate(port, duration, as_json)

    description = yarpy.ping(port)
    if as_json:
        print_json({"port": port, **read_description(description)})
    else:
        for line in description:
            print_line(as_shown(line))
    return 0


def as_shown(line: str) -> str:
    """A line of a description as C++ shows it: names and addresses in quotes."""

    return yarpy.Bottle.from_text(line).to_text()


def read_description(lines: Sequence[str]) -> dict[str, Any]:
    """The facts in the lines of a description. Raises nothing: unknown lines are passed over."""
    found: dict[str, Any] = {"address": "", "outputs": [], "inputs": []}
    for line in lines:
        words = line.split()
        if line.startswith("This is ") and len(words) == 5:
            found["address"] = words[4]
        elif line.startswith("There is an ") and len(words) == 11:
            direction, carrier = words[3], words[10]
            peer = words[8] if direction == "output" else words[6]
            if peer != "<ping>":
                found[f"{direction}s"].append({"name": peer, "carrier": carrier})
    return found


def _measure_time(port: str, as_json: bool) -> int:
    from yarpy.network.asking import find_port
    from yarpy.port.connect import probe

    if not as_json:
        print_line(f"Timing communication with {port}...")
    connecting: list[float] = []
    whole: list[float] = []
    for number in range(1, ROUNDS + 1):
        started = time.perf_counter()
        contact: yarpy.Contact = find_port(port)
        found = time.perf_counter()
        probe.ask(contact, [yarpy.Vocab("ver")])
        ended = time.perf_counter()
        connecting.append(ended - found)
        whole.append(ended - started)
        if as_json:
            continue
        print_line(f"Ping #{number}:")
        print_line(
            f"  {seconds(connecting[-1])} connection time ({seconds(whole[-1])} with name lookup)"
        )
        if number > 1:
            print_line(f"  {spread(connecting)} on average ({spread(whole)} with name lookup)")
    if as_json:
        print_json({"port": port, "connection_times": connecting, "with_lookup": whole})
    return 0


def _measure_rate(port: str, duration: float, as_json: bool) -> int:
    from yarpy.cli.ports import ANY, hear_from, open_port

    times: list[float] = []
    with open_port(
        yarpy.Port, ANY, callback=lambda message: times.append(time.perf_counter())
    ) as listener:
        hear_from(listener, port)
        if not as_json:
            print_line(f"Measuring rate of output from {port}...")
            print_line(f"Pausing for {duration:g} seconds...")
        time.sleep(duration)
        periods = [later - earlier for earlier, later in pairwise(times)]
    mean, deviation = (fmean(periods), pstdev(periods)) if periods else (0.0, 0.0)
    if as_json:
        print_json({"port": port, "messages": len(times), "period": mean, "deviation": deviation})
    else:
        print_line(f"Period is {mean:g} +/- {deviation:g} ({len(times)})")
    return 0 if times else 1


def seconds(value: float) -> str:
    """A short time with the unit that suits it.

    >>> seconds(0.00039148331), seconds(0.00286055), seconds(2.5)
    ('391.48331 us', '2.86055 ms', '2.50000 s')
    """
    for unit, factor in (("us", 1e6), ("ms", 1e3)):
        if value * factor < 1000:
            return f"{value * factor:.5f} {unit}"
    return f"{value:.5f} s"


def spread(values: Sequence[float]) -> str:
    """Mean and standard deviation of some times."""
    return f"{seconds(fmean(values))} +/- {seconds(pstdev(values))}"
