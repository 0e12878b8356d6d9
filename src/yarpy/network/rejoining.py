"""Another carrier for a connection that exists, which keeps what it was given.

Rules: a connection is made anew for that, and has lost its priority and deadline then; so these are
read before and asked for again, at each end what that end had. A connection whose new carrier is
refused goes on over the old one, which C++ ports do not see to themselves.
"""

from __future__ import annotations

import time
from contextlib import suppress
from typing import Final, TypeAlias

from yarpy.errors import UnknownName, YarpError
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.network.connection import disconnect, join
from yarpy.network.pairing import Pairing, existing
from yarpy.network.qos import grant, granted
from yarpy.qos import Qos

APPEARS: Final = 1.0  # seconds within which the other end knows of a connection, too
_POLL: Final = 0.02

Settings: TypeAlias = tuple[Qos, Qos]  # the sender's and the receiver's

log = logger("yarpy.network")


def rejoin(
    source: str, target: str, carrier: str, before: str, *, names: NameClient | None = None
) -> None:
    """Make the connection `source` -> `target` anew over `carrier`, with the priority and deadline
    that it has; where that is refused it goes on over `before`. One that was dialled by address
    goes by the name then. Raises like `connection.join`."""
    had = settings(source, target, names)
    with Pairing(source, target, "", names) as pairing:
        by_address = pairing.dialled()
    if by_address:
        disconnect(source, target, names=names)  # by name it would be a second one
    try:
        join(source, target, carrier, names=names)
    except YarpError:
        with suppress(YarpError):
            if before and not existing(source, target, names):
                join(source, target, before, names=names)
                give_back(source, target, had, names)
        raise
    give_back(source, target, had, names)


def settings(source: str, target: str, names: NameClient | None) -> Settings | None:
    """Return the settings of a connection at its two ends; None where one of them cannot be
    asked."""
    try:
        return granted(source, target, names)
    except YarpError:
        return None


def give_back(source: str, target: str, had: Settings | None, names: NameClient | None) -> None:
    """Give these settings to a connection that was just made, as far as it lacks them."""
    if had is None:
        return
    until = time.monotonic() + APPEARS
    try:
        while (has := settings(source, target, names)) is None:
            if time.monotonic() > until:
                raise UnknownName("the new connection is not known at both ends")
            time.sleep(_POLL)
        sender, receiver = (_rest(old, new) for old, new in zip(had, has, strict=True))
        grant(source, target, sender=sender, receiver=receiver, names=names)
    except YarpError as error:
        log.warning("%s -> %s has not the priority it had: %s", source, target, error)


def _rest(had: Qos, has: Qos) -> Qos | None:
    """Return the QoS that is still missing; None for nothing."""
    usual = (had.policy, had.priority) == (has.policy or "SCHED_OTHER", has.priority or 0)
    found = Qos(
        None if usual else had.policy,
        None if usual else had.priority,
        packets=had.packets if had.packets != has.packets else None,
        deadline=had.deadline,
        rate=had.rate,
        late=had.late,
    )
    return None if found == Qos() else found
