"""MQTT, by the carrier of yarpy: topics of a broker, as they are written. No library is needed.

Rules: the broker is said by WRAPYFI_MQTT_BROKER_ADDRESS and _PORT, or by `broker_address` and
`broker_port`; `mqtt_kwargs` may have `username` and `password`. Without any of these it is the
public one that programs for Wrapyfi have always taken, and a warning says so. A broker that goes
away is dialled again. Topics alone: there are no requests.
"""

from __future__ import annotations

import json
import logging
import os
import time
from typing import Any
from urllib.parse import quote

import yarpy
from wrapyfi.middlewares._headed import headed
from wrapyfi.middlewares._side import Medium, Nothing, offer

_PUBLIC = "broker.emqx.io"
_PAUSE = 0.2  # seconds between two attempts


class MqttMiddlewarePubSub(Nothing):
    """Programs name it."""


def _target(options: dict[str, Any], topic: str, *words: str) -> str:
    """The topic as something to connect to."""
    address = options.get("broker_address") or os.environ.get("WRAPYFI_MQTT_BROKER_ADDRESS")
    port = options.get("broker_port") or os.environ.get("WRAPYFI_MQTT_BROKER_PORT", "1883")
    if not address:
        address = _PUBLIC
        logging.warning(
            "[wrapyfi] %s goes over %s, where everybody can read it: set "
            "WRAPYFI_MQTT_BROKER_ADDRESS to a broker of yours",
            topic,
            address,
        )
    known = dict(options.get("mqtt_kwargs") or {})
    carrier = ["mqtt", *words]
    for word, name in (("user", "username"), ("password", "password")):
        if known.get(name):
            carrier.append(f"{word}.{quote(str(known[name]), safe='')}")
    return f"{'+'.join(carrier)}://{address}:{port}/{topic}"


class _Dialled:
    """A port that is connected to the broker, as soon as that is there."""

    def __init__(self, target: str) -> None:
        self._target = target
        self.port = yarpy.BufferedPort("", strict=True)
        self._connected = False
        self._next = 0.0

    def _dial(self) -> bool:
        if self._connected or time.monotonic() < self._next:
            return self._connected
        try:
            self.port.connect(self._target)
            self._connected = True
        except (yarpy.LinkClosed, yarpy.Timeout) as error:
            self._next = time.monotonic() + _PAUSE
            logging.debug("[wrapyfi] no broker yet: %s", error)
        return self._connected

    def wait(self, seconds: float) -> bool:
        """Wait for the broker; it does not say who has subscribed."""
        deadline = time.monotonic() + seconds
        while not self._dial():
            if time.monotonic() >= deadline:
                return False
            time.sleep(_PAUSE / 4)
        return True

    def close(self) -> None:
        self.port.close()


class _Out(_Dialled):
    def __init__(self, side: Any) -> None:
        super().__init__(_target(side.options, side.out_topic))

    def send(self, spelled: bytes) -> None:
        if self._dial():
            self.port.write(spelled)


class _In(_Dialled):
    def __init__(self, side: Any) -> None:
        super().__init__(_target(side.options, side.in_topic, "sub"))

    def receive(self, timeout: float | None) -> bytes:
        if timeout != 0:
            return self.port.read(timeout).as_(bytes)
        message = self.port.poll()
        if message is None:
            raise yarpy.Timeout("nothing came")
        return message.as_(bytes)


def _join(header: dict[str, Any], body: bytes) -> bytes:
    text = json.dumps(header).encode()
    return len(text).to_bytes(4, "big") + text + body


offer(Medium("mqtt", headed(_join), _Out, _In, forgiving=True))
