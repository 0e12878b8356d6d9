"""The parameter server of Wrapyfi over ZeroMQ: texts by path, changed by requests, heard as topics.

    REP   5659    "set /foo/bar/42", "get /foo/bar", "read /foo", "delete /foo/bar"
    XPUB  5655    [b"/foo", b"bar", b"42"] again and again, for whoever subscribes to b"/foo"
    XSUB  5656    who publishes [b"/foo"] has all parameters below it told once more

Rules: the words and answers are Wrapyfi's. `get` is answered with the value, `set` with what the
value is below. One thread has all sockets, whatever `proxy_broker_spawn` says. Parameters are told
in turns, ten milliseconds apart, and only while somebody subscribes.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any, Final

import zmq

from wrapyfi.utils.core_utils import SingletonOptimized
from yarpy.limit import ZMQ_MESSAGE

_PAUSE: Final = 0.01  # seconds between two turns
_LOOK: Final = 100  # milliseconds between two looks whether to end
_MOST: Final = 100_000  # parameters, and subscriptions
_MALFORMED: Final = "error:::malformed request"
_UNKNOWN: Final = "error:::parameter does not exist"


class Parameters:
    """The texts, and the answers to requests. No sockets."""

    def __init__(self) -> None:
        self.values: dict[str, str] = {"WRAPYFI_ACTIVE": "True"}

    def answer(self, request: str) -> str:
        """Do what a request says."""
        for word in ("get", "read", "set", "delete"):
            if request.startswith(word):
                doing: Callable[[str], str] = getattr(self, f"_{word}")
                return doing(request[len(word) + 1 :])
        return "error:::invalid request"

    def _get(self, name: str) -> str:
        return self.values.get(name, _UNKNOWN)

    def _read(self, prefix: str) -> str:
        found = any(name.startswith(prefix) for name in self.values)
        return f"success:::{prefix}" if found else _UNKNOWN

    def _set(self, line: str) -> str:
        if line.count("/") < 2:
            return _MALFORMED
        prefix, name, value = line.rsplit("/", 2)
        whole = f"{prefix}/{name}" if prefix else name
        if whole not in self.values and len(self.values) >= _MOST:
            return f"error:::there are {_MOST} parameters, which is the most"
        self.values[whole] = value
        return f"success:::{prefix}"

    def _delete(self, line: str) -> str:
        if "/" not in line:
            return _MALFORMED
        prefix, name = line.rsplit("/", 1)
        if self.values.pop(f"{prefix}/{name}" if prefix else name, None) is None:
            return _UNKNOWN
        return f"success:::{prefix}"

    def told(self, prefix: str = "") -> Iterator[list[bytes]]:
        """Each parameter whose path begins so, as what subscribers hear of it."""
        for whole, value in self.values.items():
            if whole.startswith(prefix):
                below, _, name = whole.rpartition("/")
                yield [below.encode(), name.encode(), value.encode()]


class ZeroMQMiddlewareParamServer(metaclass=SingletonOptimized):
    """The server of this program: `activate()` starts it, `deinit()` ends it."""

    def __init__(
        self,
        zeromq_proxy_kwargs: dict[str, Any] | None = None,
        zeromq_post_kwargs: dict[str, Any] | None = None,
        *args: Any,
        **kwargs: Any,
    ) -> None:
        options = zeromq_proxy_kwargs or {}
        self.parameters = Parameters()
        self._subscriptions: set[bytes] = set()
        self._verbose = bool(options.get("verbose"))
        self._interval = max(float(options.get("param_poll_interval", 1)) / 1000, _PAUSE)
        self._ended = threading.Event()
        self._context = zmq.Context()
        self._requests = self._bound(zmq.REP, options, "reqrep", 5659)
        self._out = self._bound(zmq.XPUB, options, "pub", 5655)
        self._in = self._bound(zmq.XSUB, options, "sub", 5656)
        self._in.send(b"\x01")  # or nothing that is published would come
        self._thread = threading.Thread(target=self._run, name="wrapyfi parameters", daemon=True)
        self._thread.start()

    def _bound(self, kind: int, options: dict[str, Any], word: str, number: int) -> Any:
        address = options.get(f"param_{word}_address", f"tcp://127.0.0.1:{number}")
        socket = self._context.socket(kind)
        socket.setsockopt(zmq.LINGER, 0)
        socket.setsockopt(zmq.MAXMSGSIZE, ZMQ_MESSAGE)
        try:
            socket.bind(address)
        except zmq.ZMQError as error:
            self._context.destroy(linger=0)
            raise OSError(
                f"the parameter server cannot have {address}: {error}; another one may be there"
            ) from error
        return socket

    @classmethod
    def activate(cls, **kwargs: Any) -> ZeroMQMiddlewareParamServer:
        """Start the server, unless this program has one. Raises OSError where its places are taken.

        `param_pub_address`, `param_sub_address`, `param_reqrep_address` are where it listens.
        """
        return cls(zeromq_proxy_kwargs=kwargs)

    @staticmethod
    def deinit() -> None:
        """End the server of this program; without one nothing happens."""
        found = SingletonOptimized._instances.pop(ZeroMQMiddlewareParamServer, None)
        if found is not None:
            found._ended.set()
            found._thread.join()

    def _run(self) -> None:
        try:
            due = time.monotonic()
            while not self._ended.is_set():
                now = time.monotonic()
                if self._subscriptions and now >= due:
                    self._tell("")
                    due = now + self._interval
                wait = 1000 * (due - now) if self._subscriptions else _LOOK
                self._serve(max(wait, 0))
        finally:
            self._context.destroy(linger=0)

    def _serve(self, milliseconds: float) -> None:
        poller = zmq.Poller()
        for socket in (self._requests, self._out, self._in):
            poller.register(socket, zmq.POLLIN)
        for socket, _ in poller.poll(milliseconds):
            frames = socket.recv_multipart()
            if self._verbose:
                logging.info("[ZeroMQ] parameter server: %r", frames)
            text = frames[0].decode("utf-8", "replace")
            if socket is self._requests:
                socket.send_string(self.parameters.answer(text))
            elif socket is self._in:
                self._tell(text)
            elif frames[0][:1] == b"\x01" and len(self._subscriptions) < _MOST:
                self._subscriptions.add(frames[0])
            elif frames[0][:1] == b"\x00":
                self._subscriptions.discard(b"\x01" + frames[0][1:])

    def _tell(self, prefix: str) -> None:
        for frames in self.parameters.told(prefix):
            self._out.send_multipart(frames)
