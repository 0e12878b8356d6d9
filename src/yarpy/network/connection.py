"""Connections between any two ports: make and end them, check and wait for them.

Rules: all requests go to the ports themselves, in the messages that C++ tools send; nothing
here needs a port of its own. `names` None is the default name service.
"""

from __future__ import annotations

import time
from math import inf

from yarpy import scope
from yarpy.contact import parse_contact
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed, Timeout, UnknownName, UnknownPlugin
from yarpy.link.begin.handshake import find_carrier
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT
from yarpy.network.asking import ask_server, confirmed
from yarpy.network.pairing import Pairing, existing, written
from yarpy.port.connect import probe, refusal
from yarpy.port.connect.choosing import offers_memory
from yarpy.route import masked
from yarpy.scope import ASKING, CONNECTING, Scope, apart, moment

_POLL = 0.05  # seconds between looks while waiting


@apart
def join(
    source: str,
    target: str,
    carrier: str = "",
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> tuple[str, str]:
    """Connect two ports; returns the carrier and the answer of the port that was asked. Raises
    like `remote.connect`.
    """
    with Scope(moment(CONNECTING if timeout is None else timeout)) as call:
        first: UnknownName | None = None  # which tells whose name is near; later time may be over
        while True:
            try:
                return _join(source, target, carrier, names)
            except (UnknownName, LinkClosed) as error:
                if isinstance(error, UnknownName):
                    first = first or error
                assert call.until is not None
                if timeout is None or time.monotonic() + _POLL >= call.until:
                    if isinstance(error, UnknownName):
                        raise first or error from None
                    raise
            scope.sleep(_POLL)


def _join(source: str, target: str, carrier: str, names: NameClient | None) -> tuple[str, str]:
    from_ = parse_contact(source)
    offers = False
    if not (carrier or from_.placed or written(source) or written(target)):
        # First of all: where a name is can then be asked over the same connection.
        offers = offers_memory(from_, names or DEFAULT.current())
    with Pairing(source, target, carrier, names) as pairing:
        return _joined(pairing, source, target, carrier, names, offers)


def _joined(
    pairing: Pairing,
    source: str,
    target: str,
    carrier: str,
    names: NameClient | None,
    offers: bool,
) -> tuple[str, str]:
    if pairing.topical:
        ask_server(names, ["subscribe", _decorated(source, ""), _decorated(target, carrier or "")])
        return carrier or "tcp", "connection to topic added."
    pairing.confirm(names or DEFAULT.current())
    active = pairing.source if pairing.pull else pairing.target
    address = f"/{active.address}{active.name}" if active.reachable else active.name
    over, spec = f"{pairing.spec.whole}:/", str(pairing.spec)
    chooses = pairing.open and offers
    reply = pairing.admin(Vocab("add"), address if chooses else over + address)
    text = plain_text(reply[1]).strip() if len(reply) > 1 else ""
    if reply and reply[0] == 0:
        if chooses:  # its answer names what is not tcp
            before, to, told = text.rpartition(" to ")
            spec = parse_contact(told).carrier or spec
            text = text if told != address else before + to + over + told
        return spec, text
    way = f'"{masked(source)}" -> "{masked(target)}" over {pairing.spec}'
    error = refusal.error(text, way)
    if isinstance(error, LinkClosed):
        pairing.confirm_other(names or DEFAULT.current())
        try:
            find_carrier(pairing.spec)
        except UnknownPlugin as unheard:  # so it may be a typing error
            said = str(unheard) in str(error)  # by a port of ours
            raise UnknownPlugin(str(error) if said else f"{error}; {unheard}") from None
    raise error


def _decorated(text: str, carrier: str) -> str:
    contact = parse_contact(text)
    return text if contact.carrier or not carrier else f"{carrier}:/{contact.name}"


@apart
def disconnect(
    source: str, target: str, *, names: NameClient | None = None, timeout: float | None = None
) -> bool:
    """End the connection of two ports, within `timeout` seconds, else 5; False if there was none.
    Raises like `join`."""
    with (
        Scope(moment(CONNECTING if timeout is None else timeout)),
        Pairing(source, target, "", names) as pairing,
    ):
        if pairing.topical:
            ask_server(names, ["unsubscribe", source, target])
            return True
        return pairing.delete(names or DEFAULT.current())


@apart
def is_connected(
    source: str,
    target: str,
    carrier: str = "",
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> bool:
    """Return whether two ports are connected (over `carrier`, if given). False also if the ports do
    not answer within `timeout` seconds, else 3. Raises NoNameServer."""
    with Scope(moment(ASKING if timeout is None else timeout)):
        return _is_connected(source, target, carrier, names)


def _is_connected(source: str, target: str, carrier: str, names: NameClient | None) -> bool:
    try:
        found = existing(source, target, names)
    except (UnknownName, LinkClosed, Timeout):
        return False
    return bool(found) and (not carrier or masked(carrier) == found)


@apart
def exists(
    name: str,
    target: str | None = None,
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> bool:
    """Return whether the port `name` is known and answers within `timeout` seconds, else 3; with
    `target`, whether they are connected. Raises NoNameServer."""
    with Scope(moment(ASKING if timeout is None else timeout)):
        return _exists(name, target, names)


def _exists(name: str, target: str | None, names: NameClient | None) -> bool:
    if target is not None:
        return _is_connected(name, target, "", names)
    try:
        return probe.answers(confirmed(name, names))
    except (UnknownName, LinkClosed, Timeout):  # perhaps another port listens there
        return False


@apart
def wait_for(
    name: str,
    target: str | None = None,
    timeout: float | None = None,
    *,
    names: NameClient | None = None,
) -> bool:
    """Wait until the port `name` exists (with `target`: until the two are connected).

    False when `timeout` seconds were not enough. Raises NoNameServer.
    """
    with Scope(moment(timeout)) as call:
        while not exists(name, target, names=names):
            left = inf if call.until is None else call.until - time.monotonic()
            if left <= _POLL:  # too little for another look: the rest is waited out
                time.sleep(max(left, 0.0))
                return False
            scope.sleep(_POLL)
        return True
