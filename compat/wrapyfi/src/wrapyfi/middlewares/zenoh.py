"""Zenoh, by eclipse-zenoh: a topic is a key without slashes at its ends.

Rules: where and how is said by WRAPYFI_ZENOH_IP, _PORT, _MODE, _CONNECT, _LISTEN (lists in JSON, or
with commas), _CONFIG_FILEPATH, or by the options `ip`, `port`, `mode` and `zenoh_kwargs`. One
session for each of these, closed with the last that uses it. Topics alone: there are no requests.
"""

from __future__ import annotations

import json
import os
import threading
import time
from typing import Any

import yarpy
from wrapyfi.middlewares._arrivals import Arrivals
from wrapyfi.middlewares._headed import headed
from wrapyfi.middlewares._side import Medium, Nothing, offer

try:
    import zenoh
    from zenoh.handlers import Callback
except ImportError as error:
    raise ImportError("it needs eclipse-zenoh: pip install 'yarpy-wrapyfi[zenoh]'") from error

_GREETING = 0.2  # seconds that the first value waits for listeners that are there already

_sessions: dict[tuple[int, str], tuple[Any, list[object]]] = {}
_lock = threading.Lock()  # of the sessions


class ZenohMiddlewarePubSub(Nothing):
    """Programs name it."""


def _variable(name: str, default: str = "") -> str:
    return os.environ.get(f"WRAPYFI_ZENOH_{name}", default)


def _places(name: str) -> list[str]:
    """A list of endpoints from the environment."""
    text = _variable(name).strip()
    if text.startswith("["):
        return [str(one) for one in json.loads(text)]
    return [one.strip() for one in text.split(",") if one.strip()]


def _settings(options: dict[str, Any]) -> dict[str, Any]:
    """Return the settings of a session, by the keys of Zenoh's configuration."""
    host = options.get("ip") or _variable("IP", "127.0.0.1")
    port = options.get("port") or _variable("PORT", "7447")
    found: dict[str, Any] = {
        "mode": options.get("mode") or _variable("MODE", "peer"),
        "connect/endpoints": _places("CONNECT") or [f"tcp/{host}:{port}"],
    }
    listen = _places("LISTEN")
    if listen:
        found["listen/endpoints"] = listen
    return found | dict(options.get("zenoh_kwargs") or {})


def _key(topic: str) -> str:
    return topic.strip("/")


class _Session:
    """One use of the session for these options."""

    def __init__(self, options: dict[str, Any]) -> None:
        settings = _settings(options)
        self._id = os.getpid(), json.dumps(settings, sort_keys=True)
        with _lock:
            if self._id not in _sessions:
                _sessions[self._id] = _opened(settings), []
            self.session, users = _sessions[self._id]
            users.append(self)

    def leave(self) -> None:
        with _lock:
            session, users = _sessions.get(self._id, (None, []))
            if self not in users:
                return
            users.remove(self)
            if users:
                return
            del _sessions[self._id]
        session.close()


def _opened(settings: dict[str, Any]) -> Any:
    file = _variable("CONFIG_FILEPATH")
    config = zenoh.Config.from_file(file) if file else zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        where = ", ".join(settings["connect/endpoints"])
        raise yarpy.LinkClosed(
            f"no router of Zenoh at {where} ({error}): start one (`yarpy router`), or say where it "
            "is by WRAPYFI_ZENOH_IP and WRAPYFI_ZENOH_PORT"
        ) from error


class _Out(_Session):
    def __init__(self, side: Any) -> None:
        super().__init__(side.options)
        self._publisher: Any = self.session.declare_publisher(_key(side.out_topic))
        self._fresh = True

    def wait(self, seconds: float) -> bool:
        """Listeners are not waited for, as it was; the session is there."""
        return True

    def send(self, spelled: bytes) -> None:
        publisher = self._publisher
        if publisher is None:
            raise yarpy.PortClosed("this was closed")
        deadline = time.monotonic() + _GREETING
        while self._fresh and not publisher.matching_status.matching:
            if time.monotonic() > deadline:
                break
            time.sleep(0.005)
        self._fresh = False
        publisher.put(spelled)

    def close(self) -> None:
        publisher, self._publisher = self._publisher, None
        if publisher is not None:
            publisher.undeclare()
            self.leave()


class _In(Arrivals, _Session):
    def __init__(self, side: Any) -> None:
        Arrivals.__init__(self, side)
        _Session.__init__(self, side.options)
        self._subscriber: Any = self.session.declare_subscriber(
            _key(side.in_topic),
            Callback(lambda sample: self.arrived(sample.payload.to_bytes()), indirect=False),
        )

    def close(self) -> None:
        super().close()
        subscriber, self._subscriber = self._subscriber, None
        if subscriber is not None:
            subscriber.undeclare()
            self.leave()


def _join(header: dict[str, Any], body: bytes) -> bytes:
    return json.dumps(header).encode() + b"\n" + body


offer(Medium("zenoh", headed(_join), _Out, _In, forgiving=True))
