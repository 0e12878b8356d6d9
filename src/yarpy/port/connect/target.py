"""Targets: what a program says a connection is to lead to, and over which carrier.

Rules: this is about words alone and knows no port, so that programs that ask a port something, and
have none of their own, need not load one. A text is what C++ YARP makes of it; one that cannot be
meant is an error that says what can.
"""

from __future__ import annotations

from yarpy.contact import Contact, parse_contact, reach
from yarpy.errors import LocalProtocolError, UnknownName, YarpError
from yarpy.route import CarrierSpec, parse_carrier


def unknown(name: str, names: object, carrier: str = "") -> UnknownName:
    """The error for a name that nobody knows, with the nearest one that somebody does."""
    from difflib import get_close_matches

    if reach(carrier).broker:
        base = parse_carrier(carrier).base
        return UnknownName(
            f'no port "{name}" is registered; is it a broker? its topics are {base}://HOST/TOPIC'
        )
    near: list[str] = []
    try:
        known = {contact.name: contact for contact in names.list()}  # type: ignore[attr-defined]
        if name in known and known[name].carrier == "topic":
            return UnknownName(
                f'"{name}" is a topic, not a port: a port whose name is {name}@/NODE takes '
                "part in it"
            )
        near = get_close_matches(name, known.keys() - {name}, n=1)
    except (YarpError, AttributeError):
        pass
    hint = f'did you mean "{near[0]}"?' if near else "is its program running?"
    if "://" in name and not near:
        hint = "an address is CARRIER://HOST:NUMBER, over TCP; there is no ipc and no inproc"
    return UnknownName(f'no port "{name}" is registered: {hint} (`yarpy name list` shows all)')


def is_topic(contact: Contact) -> bool:
    """Return whether the target is no port but a topic, key or service, which only one protocol
    leads to."""
    return contact.reaches.topic or contact.reaches.broker


def refuse_medium(carrier: str) -> None:
    """Raise LocalProtocolError for a carrier that leads to no port, where one is named."""
    if reach(carrier).topic:
        base = parse_carrier(carrier).base
        raise LocalProtocolError(
            f"{base} leads to what is no port: one end is {base}://..., else leave it out"
        )


def agreed(given: str, fixed: str) -> CarrierSpec:
    """The carrier of an end that speaks `fixed` alone, with what is added to the one that is given,
    if any. Raises LocalProtocolError if that is another one."""
    wanted, spec = parse_carrier(given or fixed), parse_carrier(fixed)
    if wanted.base != spec.base:
        raise LocalProtocolError(f"conflict between {wanted} and {spec}")
    return spec.plus(*(one for one in wanted.tokens if one not in spec.tokens))


def joined(dest: str, carrier: str) -> str:
    """Destination and carrier as one text, the way C++ puts them together.

    Raises LocalProtocolError for two that do not go together."""
    if not carrier:
        return dest
    bare = parse_contact(dest) if dest else None
    if bare is not None and is_topic(bare):
        carrier = agreed(carrier, bare.carrier).whole
    else:
        refuse_medium(carrier)
    if bare is not None and bare.carrier and not bare.reachable:
        dest = bare.name
    if bare is not None and bare.reachable:
        return f"{carrier}://{bare.address}{bare.name}"
    return f"{carrier}:/{dest}"
