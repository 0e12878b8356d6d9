"""`yarpy sched ...`: show or set the scheduling of a connection's thread, at either end.

    sched get SOURCE TARGET [--src | --des] [--policy | --policy-label | --priority]
    sched set SOURCE TARGET [--src VALUE] [--des VALUE]
    sched describe                               the policies

A VALUE is a policy and a priority, `FIFO:30`; as in C++ also `POL:1` (0 OTHER, 1 FIFO, 2 RR) or
`PRT:30` alone. What is shown is what the system does; -1 says that the end has no thread of its
own: an output is sent by the thread that writes, until it is scheduled.

Differs from C++: the two ends are printed with a blank between them.
Exit codes: 0; 1 no such port or connection, refused (the text says what is missing), wrong value.
"""

from __future__ import annotations

import click

from yarpy.cli.ends import grant, of_a_connection, show
from yarpy.cli.output import print_line
from yarpy.qos import POLICIES, Qos, policy_name, policy_of


@click.group()
def command() -> None:
    """Show or set the scheduling of a connection's thread."""


@command.command()
@of_a_connection
@click.option("--policy", "form", flag_value="policy", help="Only the number of the policy.")
@click.option("--policy-label", "form", flag_value="label", help="Only the name of the policy.")
@click.option("--priority", "form", flag_value="priority", help="Only the priority.")
def get(source: str, target: str, side: str | None, form: str | None) -> int:
    """Print how the system schedules the threads of both ends."""
    print_line(show(source, target, side, lambda qos: f"(sched ({spelled(qos, form)}))"))
    return 0


def spelled(qos: Qos, form: str | None) -> str:
    """`(policy 1) (priority 30)`, or one part of it."""
    sched = qos.sched
    if form == "label":
        return f"(policy {qos.policy or 'SCHED_INVALID'})"
    parts = {"policy": f"(policy {sched.policy})", "priority": f"(priority {sched.priority})"}
    return parts[form] if form else " ".join(parts.values())


@command.command("set")
@click.argument("source")
@click.argument("target")
@click.option("--src", "sender", metavar="VALUE", help="For the thread that sends.")
@click.option("--des", "receiver", metavar="VALUE", help="For the thread that receives.")
def set_(source: str, target: str, sender: str | None, receiver: str | None) -> int:
    """Schedule the threads of a connection."""
    grant(source, target, sender, receiver, parse)
    return 0


def parse(text: str) -> Qos:
    """A value of the command line. Raises click.BadParameter."""
    kind, _, value = text.partition(":")
    try:
        if kind.upper() == "PRT":
            return Qos(priority=int(value))
        if kind.upper() == "POL":
            policy = policy_of(int(value) if value.isdigit() else value)
            # C++ gives a real-time thread the least priority if none is said.
            return Qos(policy_name(policy), 1 if policy else 0)
        policy = policy_of(int(kind) if kind.isdigit() else kind)
        least = 1 if policy else 0
        return Qos(policy_name(policy), int(value) if value else least)
    except ValueError as error:
        raise click.BadParameter(f"{error}; a value looks like FIFO:30") from error


@command.command()
def describe() -> int:
    """List the policies."""
    for name, number in POLICIES.items():
        takes = "priority 1 to 99" if number else "no priority"
        print_line(f"{number} {name}: {takes}")
    return 0
