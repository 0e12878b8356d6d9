"""Settings of both ends of a connection, shown and set: for `yarpy qos` and `yarpy sched`.

Rules: `--src` is the end of the port that sends, `--des` that of the port that receives.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from yarpy.network import qos
from yarpy.qos import Qos

SOURCE, TARGET = click.argument("source"), click.argument("target")
ONLY_SOURCE = click.option("--src", "side", flag_value="src", help="Only the end of SOURCE.")
ONLY_TARGET = click.option("--des", "side", flag_value="des", help="Only the end of TARGET.")


def of_a_connection(command: Callable[..., Any]) -> Callable[..., Any]:
    """Arguments SOURCE and TARGET, options --src and --des: what is shown of which end."""
    return SOURCE(TARGET(ONLY_SOURCE(ONLY_TARGET(command))))


def show(source: str, target: str, side: str | None, spell: Callable[[Qos], str]) -> str:
    """`(src (...)) (des (...))`, or one of them alone."""
    sender, receiver = qos.granted(source, target)
    parts = {"src": f"(src {spell(sender)})", "des": f"(des {spell(receiver)})"}
    return parts[side] if side else " ".join(parts.values())


def grant(
    source: str,
    target: str,
    sender: str | None,
    receiver: str | None,
    parse: Callable[[str], Qos],
) -> None:
    """Ask for the values that were given, as `parse` reads them. Raises click.UsageError."""
    if sender is None and receiver is None:
        raise click.UsageError("say at which end: --src VALUE, --des VALUE, or both")
    ends = [None if text is None else parse(text) for text in (sender, receiver)]
    qos.grant(source, target, sender=ends[0], receiver=ends[1])
