"""WebSocket, by python-socketio: events of a Socket.IO server, which sends each on to everybody.

Rules: the server is said by WRAPYFI_WEBSOCKET_SOCKET_IP, _SOCKET_PORT and _NAMESPACE, or by
`socket_ip`, `socket_port` and `namespace`; `websocket_kwargs` goes to the library. One connection
for each of these, dialled again until it is there. An event has the name of its topic; pixels go
as base64, samples as bytes. Topics alone: there are no requests.
"""

from __future__ import annotations

import json
import logging
import os
import threading
import time
from base64 import b64decode, b64encode
from functools import partial
from importlib.util import find_spec
from typing import Any

from wrapyfi.middlewares._arrivals import Arrivals
from wrapyfi.middlewares._headed import PictureForm, SoundForm, TextForm
from wrapyfi.middlewares._side import Medium, Nothing, offer

if find_spec("socketio") is None:
    raise ImportError("it needs python-socketio: pip install 'yarpy-wrapyfi[websocket]'")

_PAUSE = 0.2  # seconds between two attempts

_clients: dict[tuple[int, str], _Client] = {}
_lock = threading.Lock()  # of the clients


class WebSocketMiddlewarePubSub(Nothing):
    """Programs name it."""


class _Client:
    """A connection to a server, for all topics there."""

    def __init__(self, url: str, namespace: str, options: dict[str, Any]) -> None:
        import socketio  # takes as long as all the rest

        from wrapyfi.middlewares._socketio import Client

        self.errors = socketio.exceptions.SocketIOError, ValueError, OSError
        self.users: list[object] = []
        self.namespace = namespace
        self._url = url
        self._options = options
        self._takers: dict[str, list[_In]] = {}
        self._closed = threading.Event()
        self.socket = Client(reconnection_delay=_PAUSE, reconnection_delay_max=1)
        threading.Thread(target=self._dial, name=f"wrapyfi {url}", daemon=True).start()

    def _dial(self) -> None:
        told = False
        while not self._closed.is_set():
            try:
                self.socket.connect(self._url, namespaces=[self.namespace], **self._options)
                break
            except self.errors as error:
                if not told:
                    logging.info("[wrapyfi] no Socket.IO server at %s: %s", self._url, error)
                told = True
            self._closed.wait(_PAUSE)
        if self._closed.is_set():
            self.socket.disconnect()

    @property
    def connected(self) -> bool:
        return self.namespace in self.socket.namespaces

    def subscribe(self, taker: _In, topic: str) -> None:
        with _lock:
            takers = self._takers.setdefault(topic, [])
            takers.append(taker)

        def heard(*data: Any) -> None:
            for one in tuple(takers):
                one.heard(data)

        self.socket.on(topic, heard, namespace=self.namespace)

    def unsubscribe(self, taker: _In, topic: str) -> None:
        with _lock:
            self._takers[topic].remove(taker)

    def close(self) -> None:
        self._closed.set()
        self.socket.disconnect()


class _Session:
    """One use of the connection for these options."""

    def __init__(self, options: dict[str, Any]) -> None:
        def said(name: str, default: str) -> str:
            found = options.get(name.lower())
            return str(found or os.environ.get(f"WRAPYFI_WEBSOCKET_{name}", default))

        url = f"http://{said('SOCKET_IP', '127.0.0.1')}:{said('SOCKET_PORT', '5000')}"
        namespace = said("NAMESPACE", "/")
        known = dict(options.get("websocket_kwargs") or {})
        self._id = os.getpid(), repr((url, namespace, sorted(known.items())))
        with _lock:
            if self._id not in _clients:
                _clients[self._id] = _Client(url, namespace, known)
            self.client = _clients[self._id]
            self.client.users.append(self)

    def wait(self, seconds: float) -> bool:
        """Wait for the server; it does not say who listens."""
        deadline = time.monotonic() + seconds
        while not self.client.connected:
            if time.monotonic() >= deadline:
                return False
            time.sleep(_PAUSE / 10)
        return True

    def leave(self) -> None:
        with _lock:
            if self not in self.client.users:
                return
            self.client.users.remove(self)
            if self.client.users:
                return
            del _clients[self._id]
        self.client.close()


class _Out(_Session):
    def __init__(self, side: Any) -> None:
        super().__init__(side.options)
        self._topic = side.out_topic

    def send(self, spelled: Any) -> None:
        """Send it; until the server is there, and while it is away, values are dropped."""
        try:
            self.client.socket.emit(self._topic, spelled, namespace=self.client.namespace)
        except self.client.errors as error:
            logging.debug("[wrapyfi] %s is not sent: %s", self._topic, error)

    def close(self) -> None:
        self.leave()


class _In(Arrivals, _Session):
    def __init__(self, side: Any) -> None:
        Arrivals.__init__(self, side)
        _Session.__init__(self, side.options)
        self._topic = side.in_topic
        self.client.subscribe(self, self._topic)

    def wait(self, seconds: float) -> bool:
        return _Session.wait(self, seconds)

    def heard(self, data: Any) -> None:
        try:
            self.arrived(_bytes(data))
        except (ValueError, TypeError) as error:
            logging.error("[wrapyfi] %s: what came cannot be read: %s", self._topic, error)

    def close(self) -> None:
        if not self.closed:
            super().close()
            self.client.unsubscribe(self, self._topic)
            self.leave()


def _bytes(data: Any) -> bytes:
    """An event as text, or as a line of a header and what belongs to it."""
    if len(data) == 1 and isinstance(data[0], (list, tuple)):
        data = data[0]
    if len(data) == 1:
        return data[0].encode() if isinstance(data[0], str) else bytes(data[0])
    header, body = data
    if not isinstance(header, dict):
        raise ValueError("a header is a dict")
    body = b64decode(body, validate=True) if isinstance(body, str) else bytes(body)
    return json.dumps(header).encode() + b"\n" + body


class _TextForm(TextForm):
    """JSON as a text."""

    def spelled(self, obj: Any) -> Any:
        return self.text(obj)


def _picture(header: dict[str, Any], body: bytes) -> Any:
    return [header, b64encode(body).decode()]


def _sound(header: dict[str, Any], body: bytes) -> Any:
    return [header, body]


offer(
    Medium(
        "websocket",
        {
            "NativeObject": _TextForm,
            "Image": partial(PictureForm, join=_picture),
            "AudioChunk": partial(SoundForm, join=_sound),
        },
        _Out,
        _In,
        forgiving=True,
    )
)
