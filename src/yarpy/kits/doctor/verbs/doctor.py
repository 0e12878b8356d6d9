"""`yarpy doctor [PORT [PORT]]`: say why nothing arrives, and what mends it.

    doctor              the network: name servers, names left behind, connections at a glance; and
                        who reaches programs that are started here
    doctor PORT         a port and its connections
    doctor FROM TO      the connection from one port to another, or why there is none

It asks the ports' administrative sides, looks at a message of each sender, and at the programs of
this computer; it changes nothing and takes a few seconds at most. Exit codes: 0 nothing is wrong;
1 something is.
"""

from __future__ import annotations

import shutil
import textwrap
from dataclasses import asdict
from typing import TYPE_CHECKING, Final

import click

from yarpy.cli.output import print_json, print_line
from yarpy.log import readable

if TYPE_CHECKING:
    from yarpy.kits.doctor import Case, Finding

NARROW: Final = 40  # columns; a line on a terminal that is narrower is folded by it
WIDE: Final = 100


@click.command()
@click.argument("ports", nargs=-1, metavar="[PORT [PORT]]")
@click.option("--json", "as_json", is_flag=True, help="Print the findings as JSON objects.")
def command(ports: tuple[str, ...], as_json: bool) -> int:
    """Say why nothing arrives at a port, from one port to another, or anywhere."""
    if len(ports) > 2:
        raise click.UsageError("give no port, one, or the two ends of a connection")
    from yarpy.kits.doctor import Case, examine

    case = Case(*ports)
    findings = examine(case)
    for finding in findings:
        if as_json:
            print_json(asdict(finding))
        else:
            for line in told(finding, width()):
                print_line(line)
            print_line("")
    if not ports and not as_json:
        for line in reached(width()):
            print_line(readable(line))
        print_line("")
    faults = sum(finding.level == "fault" for finding in findings)
    if not as_json:
        for line in summary(case, faults):
            print_line(readable(line))
    return 1 if faults else 0


def told(finding: Finding, columns: int) -> list[str]:
    """A finding in lines for people. What strangers said in it is shown, not obeyed."""
    indent = "    "
    head = f"{finding.level}: {finding.probe}, {finding.about}"
    lines = [readable(head)]
    for text, first in ((finding.verdict, indent), (finding.advice, f"{indent}> ")):
        if text:
            lines += textwrap.wrap(
                readable(text), columns, initial_indent=first, break_on_hyphens=False,
                subsequent_indent=" " * len(first), break_long_words=False,
            )  # fmt: skip
    return lines


def reached(columns: int) -> list[str]:
    """Return the lines that say who reaches the programs started here, and with what."""
    from yarpy.config.doors import doors

    lines = ["who reaches programs that are started here, and with what:"]
    for entry in doors():
        lines += textwrap.wrap(
            f"{entry.who}: {entry.may} (set by {entry.setting.replace('`', '')})", columns,
            initial_indent="    ", subsequent_indent="        ", break_on_hyphens=False,
            break_long_words=False,
        )  # fmt: skip
    return lines


def summary(case: Case, faults: int) -> list[str]:
    """Return the lines that say what was examined, and how it went."""
    if case.problem is not None:
        return []
    lines = []
    for pair in case.pairs if case.wanted else []:
        if pair.now is None:
            continue
        measured = pair.now.measured("messages"), pair.now.rate, pair.now.drops
        counted = ", ".join(
            f"{value:{form}} {what}"
            for value, form, what in zip(
                measured, ("d", ".1f", "d"), ("messages", "in a second", "dropped"), strict=True
            )
            if value is not None
        )
        lines.append(f"{pair.name}: {pair.now.carrier}" + (f", {counted}" if counted else ""))
    count = len(case.ports)
    asked = f"{count} port{'s' if count != 1 else ''} asked"
    if not case.wanted:
        asked = f"{sum(map(bool, map(case.port, case.ports)))} ports answer"
    what = "nothing is wrong" if not faults else f"{faults} fault{'s' if faults > 1 else ''}"
    return [*lines, f"{what} ({asked})"]


def width() -> int:
    """Columns for text."""
    return max(NARROW, min(WIDE, shutil.get_terminal_size((80, 24)).columns))
