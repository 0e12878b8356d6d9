"""`yarpy qos ...`: show or set the priority of a connection's packets, at either end.

    qos get SOURCE TARGET [--src | --des] [--tos | --dscp | --level]
    qos set SOURCE TARGET [--src VALUE] [--des VALUE]
    qos time SOURCE TARGET [--deadline S] [--rate HZ] [--late drop|keep]
                                                 when messages should come; nothing given: show it
    qos describe [VALUE]                         the classes, or what VALUE means

A VALUE is a level (LOW, NORM, HIGH, CRIT), a DSCP class (AF42) or a TOS byte (144); with a prefix
as in C++ also `LEVEL:HIGH`, `DSCP:36`, `TOS:144`. `yarpy sched` does the same for threads.

Differs from C++: LEVEL is labelled as such also for both ends, and TOS:n works.
Exit codes: 0; 1 no such port or connection, refused, or a wrong value.
"""

from __future__ import annotations

import click

from yarpy.cli.ends import grant, of_a_connection, show
from yarpy.cli.output import print_line
from yarpy.cli.stderr import complain
from yarpy.errors import LocalProtocolError
from yarpy.qos import DSCP, LEVELS, Qos, packets_name, tos_of

FORMS = ("tos", "dscp", "level")
TIMING = ("deadline", "rate", "late", "missed", "dropped", "missing", "worst")


@click.group()
def command() -> None:
    """Show or set the priority of a connection's packets."""


@command.command(short_help="Print the priority of the packets of both ends.")
@of_a_connection
@click.option("--tos", "form", flag_value="tos", help="As a TOS byte (what is printed anyway).")
@click.option("--dscp", "form", flag_value="dscp", help="As a DSCP class.")
@click.option("--level", "form", flag_value="level", help="As LOW, NORMAL, HIGH or CRITICAL.")
def get(source: str, target: str, side: str | None, form: str | None) -> int:
    """Print the priority that the system gives the packets of both ends."""
    print_line(show(source, target, side, lambda qos: f"(qos ({spelled(qos, form or 'tos')}))"))
    return 0


def spelled(qos: Qos, form: str) -> str:
    """`(tos 144)`, `(dscp AF42)` or `(level HIGH)`."""
    tos = max(qos.tos, 0)
    if form == "dscp":
        return f"(dscp {packets_name(tos)})"
    if form == "level":
        names = {dscp: name for name, dscp in LEVELS.items()}
        long = {"NORM": "NORMAL", "CRIT": "CRITICAL"}
        name = names.get(tos >> 2, "UNDEFINED")
        return f"(level {long.get(name, name)})"
    return f"(tos {tos})"


@command.command("set")
@click.argument("source")
@click.argument("target")
@click.option("--src", "sender", metavar="VALUE", help="For what SOURCE sends.")
@click.option("--des", "receiver", metavar="VALUE", help="For what TARGET answers.")
def set_(source: str, target: str, sender: str | None, receiver: str | None) -> int:
    """Mark the packets of a connection."""
    grant(source, target, sender, receiver, lambda text: Qos(packets=parse(text)))
    return 0


def parse(text: str) -> str | int:
    """A value of the command line as Qos takes it. Raises click.BadParameter."""
    kind, colon, value = text.rpartition(":")
    kind = kind.upper() if colon else ("TOS" if text.isdigit() else "")
    try:
        if kind == "TOS":
            tos = int(value)
            if not 0 <= tos < 256:
                raise ValueError(f"a TOS byte lies between 0 and 255, not {tos}")
            return tos >> 2
        if kind == "LEVEL" and value.isdigit():
            return [*LEVELS][int(value)]
        if kind in ("", "LEVEL", "DSCP"):
            found = int(value) if value.isdigit() else value
            tos_of(found)
            return found
    except (ValueError, IndexError) as error:
        raise click.BadParameter(str(error)) from error
    raise click.BadParameter(f'"{kind}:" is none of LEVEL:, DSCP:, TOS:')


@command.command("time", short_help="Show or set when messages should come.")
@click.argument("source")
@click.argument("target")
@click.option("--deadline", type=float, metavar="S", help="Seconds a message may take; 0: any.")
@click.option("--rate", type=float, metavar="HZ", help="Messages per second that should come.")
@click.option("--late", type=click.Choice(["drop", "keep"]), help="What becomes of late ones.")
def time_(
    source: str, target: str, deadline: float | None, rate: float | None, late: str | None
) -> int:
    """Set by when and how often messages should come, and show how often they did not.

    TARGET counts; with --late drop it drops what comes late, and SOURCE does not send what is late
    already: `dropped` are both.
    """
    from yarpy.network import qos
    from yarpy.network.sampling import flow

    try:
        wanted = Qos(deadline=deadline, rate=rate, late=late)
    except ValueError as error:
        raise click.UsageError(str(error)) from error
    if wanted.timed:
        qos.grant(source, target, receiver=wanted)
        try:
            qos.grant(source, target, sender=wanted)
        except LocalProtocolError as error:  # a port of C++; what counts is the receiver
            complain(str(error))
    found = flow(source, target)
    timing = dict(found.receiver.timing) if found.receiver is not None else {}
    unsent = found.sender.timing.get("dropped") if found.sender is not None else None
    if timing and isinstance(unsent, int):
        timing["dropped"] = timing.get("dropped", 0) + unsent
    if not timing:
        print_line(f'"{target}" expects nothing of "{source}"')
    else:
        shown = [key for key in TIMING if key in timing]
        print_line(" ".join(f"({key} {_short(key, timing[key])})" for key in shown))
    return 0


def _short(key: str, value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    return f"{value:.4f}" if key == "worst" else f"{value:.4g}"


@command.command()
@click.argument("value", required=False)
def describe(value: str | None) -> int:
    """List the levels and classes, or say what VALUE is."""
    if value is not None:
        tos = tos_of(parse(value))
        qos = Qos(packets=tos >> 2)
        print_line(" ".join(spelled(qos, form) for form in FORMS))
        return 0
    for name, dscp in (*LEVELS.items(), *DSCP.items()):
        print_line(f"{name:5} DSCP {dscp:2} TOS {dscp << 2:3}")
    return 0
