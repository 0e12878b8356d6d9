"""User properties of version 5: pairs of names and values beside a message, as its envelope.

    ("unit", "deg"), ("unit", "rad")     <->     (unit deg) (unit rad)
    ("envelope", "7 1.5")                <->     7 1.5

Rules: pure. The envelope is the text of a Bottle, a list for each pair, in their order. What is no
list of pairs, such as a Stamp, travels under one name, by which ports know it again. Of a peer only
so many bytes are kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.limit import MQTT_USER
from yarpy.peers.mqtt import packet as mqtt

ENVELOPE: Final = b"envelope"  # the name of what is no list of pairs

#: name and value
Pair = tuple[bytes, bytes]


def envelope_of(pairs: Sequence[Pair]) -> str:
    """Return the envelope that says these pairs; those beyond MQTT_USER bytes are left out.

    >>> envelope_of([(b"unit", b"deg"), (b"by", b"the arm")])
    '(unit deg) (by "the arm")'
    """
    if len(pairs) == 1 and pairs[0][0] == ENVELOPE:
        return _text(pairs[0][1][:MQTT_USER])
    found, left = [], MQTT_USER
    for name, value in pairs:
        left -= len(name) + len(value)
        if left < 0:
            break
        found.append([_text(name), _text(value)])
    return Bottle(found).to_text()


def pairs_of(envelope: bytes) -> list[Pair]:
    """Return the pairs that an envelope says."""
    if not envelope:
        return []
    try:
        found = [_pair(one) for one in Bottle.from_text(envelope)]
    except DecodeError:
        found = [None]
    pairs = [one for one in found if one is not None]
    return pairs if 0 < len(pairs) == len(found) else [(ENVELOPE, envelope[:MQTT_USER])]


def properties_of(envelope: bytes) -> bytes:
    """Return an envelope as properties of a PUBLISH.

    >>> properties_of(b"7 1.5")
    b'&\\x00\\x08envelope\\x00\\x057 1.5'
    """
    return b"".join(
        bytes((mqtt.USER,)) + mqtt.string(name) + mqtt.string(value)
        for name, value in pairs_of(envelope)
    )


def _pair(one: object) -> Pair | None:
    if not isinstance(one, list) or len(one) != 2:
        return None
    name, value = one
    if type(name) is not str or type(value) is not str:
        return None
    found = name.encode(), value.encode()
    return None if max(map(len, found)) > MQTT_USER else found


def _text(data: bytes) -> str:
    return data.decode("utf-8", "replace")
