"""The first words of a port to a broker: who it is, what is kept for it, and its will.

Rules: pure. Version 3.1.1, which every broker understands; 5 for questions, sessions and delays of
wills, and with `+v5`. Sessions are clean, unless `+session.SECONDS` says for how long the broker
keeps what comes while a port that reads is away, or `+will_delay.SECONDS` for how long it waits for
a port that writes before it publishes its will: then the port has the same name there each time,
another one for reading than for writing.
"""

from __future__ import annotations

import os
from typing import Final
from zlib import crc32

from yarpy.carriers.base import refuse_unknown
from yarpy.errors import LocalProtocolError
from yarpy.limit import MQTT_TOPIC
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.session import CLEAN, DELAY, EXPIRY, HANDLING, RPC, SESSION, WILL, MqttPeer
from yarpy.route import CarrierSpec

FOREVER: Final = 0xFFFFFFFF  # seconds of a session that never expires
KEEP_ALIVE: Final = 60  # seconds of silence that we promise not to exceed
WEBSOCKET: Final = "ws"
_WORDS: Final = (
    *("sub", RPC, "session.SECONDS", "qos.1", "qos.2", "retain", "will.TEXT"),
    *("will_delay.SECONDS", "expiry.SECONDS", "retain_handling.N"),
    *("user.NAME", "password.WORD", "v5", "raw", "ws", "ws.PATH"),
)


def check(spec: CarrierSpec) -> None:
    """Raise LocalProtocolError for what no broker can be asked for."""
    refuse_unknown(spec, _WORDS)
    qos = spec.value("qos")
    if qos not in (None, "0", "1", "2"):
        raise LocalProtocolError(f"+qos.{qos[:20]}: there are QoS 0, 1 and 2")
    if spec.value("will") is not None and {"sub", RPC} & {*spec.tokens}:
        raise LocalProtocolError("+will.TEXT is for ports that write to a topic of a broker")
    if _seconds(spec, EXPIRY) and {"sub", RPC} & {*spec.tokens}:
        raise LocalProtocolError("+expiry.SECONDS is for ports that write to a topic of a broker")
    if _seconds(spec, DELAY) and spec.value("will") is None:
        raise LocalProtocolError("+will_delay.SECONDS puts off a will: say +will.TEXT as well")
    handling = spec.value(HANDLING) or "0"
    if handling not in ("0", "1", "2") or (handling != "0" and "sub" not in spec.tokens):
        raise LocalProtocolError("+retain_handling.N is for ports that read: N is 0, 1 or 2")
    _check_session(spec)
    if spec.value("password") is not None and spec.value("user") is None:
        raise LocalProtocolError("a password for a broker needs a name: say +user.NAME")


def _seconds(spec: CarrierSpec, word: str) -> bool:
    """Return whether the word is there, with a number of seconds. Raises LocalProtocolError."""
    seconds = spec.value(word)
    if seconds is None:
        return False
    if not (seconds.isascii() and seconds.isdecimal() and 0 < int(seconds[:20]) <= FOREVER):
        raise LocalProtocolError(f"+{word}.{seconds[:20]}: say seconds, {FOREVER} for no end")
    return True


def _check_session(spec: CarrierSpec) -> None:
    if not _seconds(spec, SESSION):
        return
    if "sub" not in spec.tokens or RPC in spec.tokens:
        raise LocalProtocolError("+session.SECONDS is for ports that read from topics of a broker")
    if spec.value("qos") not in ("1", "2"):
        raise LocalProtocolError("a broker keeps what has a QoS: say +qos.1 beside +session")


def one_topic(peer: MqttPeer) -> bytes:
    """Return the topic, where it has to be a single one. Raises LocalProtocolError."""
    topic = peer.topic
    if not topic or b"#" in topic or b"+" in topic or len(topic) > MQTT_TOPIC:
        raise LocalProtocolError(
            "a port writes to one topic, which stands behind the broker: mqtt://HOST/TOPIC"
        )
    return topic


def name_of(peer: MqttPeer) -> str:
    """Return the port's name as a client of the broker: a new one each time, or, where the broker
    keeps something for it, always the same."""
    spec = peer.route.spec
    if spec.value(SESSION) is not None:
        mark = f"{crc32(peer.topic):08x}"
    elif spec.value(DELAY) is not None:
        mark = f"{crc32(peer.topic):08x}-out"
    else:
        mark = os.urandom(4).hex()
    return f"yarpy{peer.route.source.replace('/', '-')}-{mark}"


def hello(peer: MqttPeer) -> bytes:
    """Return the packet CONNECT. Raises LocalProtocolError."""
    from urllib.parse import unquote_to_bytes

    def raw(word: str | None) -> bytes | None:
        return None if word is None else unquote_to_bytes(word.encode("utf-8", "surrogateescape"))

    spec = peer.route.spec
    user, password, text = (raw(spec.value(key)) for key in ("user", "password", "will"))
    delay = spec.value(DELAY)
    kept = spec.value(SESSION) or delay  # a will waits no longer than its session lasts
    flags = (
        (CLEAN if kept is None else 0)
        | (0x80 if user is not None else 0)
        | (0x40 if password is not None else 0)
    )
    if text is not None:
        flags |= WILL | (qos_of(spec) << 3) | (0x20 if "retain" in spec.tokens else 0)
    body = mqtt.string(b"MQTT") + bytes((peer.version, flags)) + KEEP_ALIVE.to_bytes(2, "big")
    body += peer.properties(seconds_of(mqtt.SESSION_EXPIRY, kept))
    body += mqtt.string(name_of(peer).encode("utf-8", "replace")[:1000])
    if text is not None:
        body += peer.properties(seconds_of(mqtt.WILL_DELAY, delay))
        body += mqtt.string(one_topic(peer)) + mqtt.string(text)
    for part in (user, password):
        if part is not None:
            body += mqtt.string(part)
    return mqtt.packet(mqtt.CONNECT, body)


def seconds_of(property_: int, seconds: str | None) -> bytes:
    """Return a property of four bytes; nothing without seconds."""
    return b"" if seconds is None else bytes((property_,)) + int(seconds).to_bytes(4, "big")


def qos_of(spec: CarrierSpec) -> int:
    """Return the quality of service that a carrier string names: 0, 1 or 2."""
    return int(spec.value("qos") or 0)
