"""The registered port that `/host:port/` stands for, as ports call a peer that was dialled by
address.

Rules: pure. An address on the loopback is meant as seen from the port that dialled it. Only names
with that very address count; where there are several, which may be names of ports that have gone,
it is for others to say which.
"""

from __future__ import annotations

from yarpy.contact import Contact, parse_contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import AddressError
from yarpy.names.address import is_loopback, plain_host


def address_in(peer: str) -> Contact | None:
    """The address by which a port calls a peer; None for a name.

    >>> address_in("/10.0.0.1:10002/")
    Contact(carrier='tcp', name='', host='10.0.0.1', port=10002)
    >>> address_in("/cam")
    """
    if ":" not in peer:
        return None
    try:
        found = parse_contact(peer)
    except AddressError:
        return None
    return found if found.reachable and not found.name else None


def leads_to(address: Contact, contact: Contact, host: str) -> bool:
    """Return whether `address`, dialled by a port at `host`, is where `contact` is."""
    if address.port != contact.port:
        return False
    there, meant = plain_host(contact.host), plain_host(address.host)
    return meant == there or (is_loopback(meant) and (is_loopback(there) or there == host))


def dialled_in(listed: Bottle, contact: Contact, host: str) -> str:
    """The address of `contact` in what a port at `host` lists, "" if it is not there."""
    for peer in map(plain_text, listed):
        address = address_in(peer)
        if address is not None and leads_to(address, contact, host):
            return peer
    return ""
