"""ZeroMQ, by pyzmq: topics at a broker, requests through another one.

    topics       XPUB at HOST:5555 for subscribers, XSUB at HOST:5556 for publishers
    requests     ROUTER at HOST:5558 for clients, DEALER at HOST:5559 for servers

Rules: brokers run in whichever program came first, and another one's takes over. A request has no
topic: all servers at one broker get whatever is asked there, in turn.
"""

from __future__ import annotations

import errno
import os
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import zmq

import yarpy
from wrapyfi.middlewares._form import Native, Picture, Sound
from wrapyfi.middlewares._parameters import ZeroMQMiddlewareParamServer
from wrapyfi.middlewares._side import Medium, Nothing, offer
from yarpy.kits.wrap.middleware import Failure
from yarpy.kits.wrap.value import payload
from yarpy.limit import ZMQ_MESSAGE
from yarpy.peers.zmq.broker import keep_ready
from yarpy.peers.zmq.link import In, Out, context

_PAUSE = 0.1  # seconds between two looks whether a socket was closed


def _variable(name: str, default: str) -> str:
    return os.environ.get(f"WRAPYFI_ZEROMQ_{name}", default)


def _place(options: dict[str, Any]) -> tuple[str, int, int]:
    """Host, and the numbers of XPUB and XSUB."""
    host = options.get("socket_ip") or _variable("SOCKET_IP", "127.0.0.1")
    pub = options.get("socket_pub_port") or _variable("SOCKET_PUB_PORT", "5555")
    sub = options.get("socket_sub_port") or _variable("SOCKET_SUB_PORT", "5556")
    return str(host), int(pub), int(sub)


def _broker(options: dict[str, Any]) -> tuple[str, str]:
    """The addresses of XPUB and XSUB; the broker is there from now on, unless that is refused."""
    host, pub, sub = _place(options)
    wanted = options.get("start_proxy_broker", _variable("START_PROXY_BROKER", "True"))
    if str(wanted) != "False":
        keep_ready(host, pub, sub)
    return f"tcp://{host}:{pub}", f"tcp://{host}:{sub}"


__all__ = ["ZeroMQMiddlewareParamServer", "ZeroMQMiddlewarePubSub", "ZeroMQMiddlewareReqRep"]


class ZeroMQMiddlewarePubSub(Nothing):
    """Programs name it."""


class ZeroMQMiddlewareReqRep(Nothing):
    """Programs name it."""


# ------------------------------------------------------------------------------------ topics


class _NativeForm(Native):
    """JSON behind the topic; what comes may be a frame of yarpy."""

    nothing: Any = None

    def spelled(self, obj: Any) -> Any:
        return [self.text(obj).encode()]

    def value(self, came: list[bytes]) -> Any:
        titled = len(came) == 2 and came[0].startswith(b"{timestamp")
        data = came[-1] if len(came) == 1 or titled else b""
        if not data or data[:3] == payload.JPEG or payload.frame.is_frame(data):
            return payload.of_parts(came).value
        return self.of_text(data)


def _header() -> bytes:
    return f"{{timestamp:{time.time()}}}".encode()


class _PictureForm(_NativeForm):
    """A header, and JSON of the array or a JPEG file."""

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(options)
        self._picture = Picture(options)

    def spelled(self, obj: Any) -> Any:
        if obj is None:
            return None
        array = self._picture.checked(obj)
        if self._picture.jpg:
            return [_header(), self._picture.file(array)]
        return [_header(), self.text(array).encode()]

    def value(self, came: list[bytes]) -> Any:
        if came and came[-1][:3] == payload.JPEG:
            return self._picture.of_file(came[-1])
        return np.asarray(super().value(came))


class _SoundForm(_NativeForm):
    """A header, and JSON of chunk, channels, rate and samples."""

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(options)
        self._sound = Sound(options)
        self.nothing = None, self._sound.rate

    def spelled(self, obj: Any) -> Any:
        row = self._sound.row(obj)
        return None if row is None else [_header(), self.text(row).encode()]

    def value(self, came: list[bytes]) -> Any:
        _, _, rate, samples = super().value(came)
        return samples, rate


class _Out(Out):
    def __init__(self, side: Any) -> None:
        super().__init__(side.out_topic, _broker(side.options)[1])
        if not side.should_wait:
            self.wait(0.2)  # until the broker has told who is there already


class _In(In):
    def __init__(self, side: Any) -> None:
        super().__init__(side.in_topic, _broker(side.options)[0])

    def wait(self, seconds: float) -> bool:
        """Publishers are not waited for: the broker is there."""
        return True


# ------------------------------------------------------------------------------------ requests


class _PictureAnswer(_PictureForm):
    """JSON of nested lists, or a JPEG file."""

    def spelled(self, obj: Any) -> Any:
        if obj is None:
            return [b"null"]
        array = self._picture.checked(obj)
        if self._picture.jpg:
            return [self._picture.file(array)]
        return [self.text({"img": array.tolist()}).encode()]

    def value(self, came: list[bytes]) -> Any:
        if came and came[-1][:3] == payload.JPEG:
            return self._picture.of_file(came[-1])
        found = _NativeForm.value(self, came)
        return None if found is None else np.array(found["img"], self._picture.dtype)


class _SoundAnswer(_SoundForm):
    """JSON of chunk, channels, rate and nested lists."""

    def spelled(self, obj: Any) -> Any:
        row = self._sound.row(obj)
        whole = None if row is None else {"aud": [*row[:3], row[3].tolist()]}
        return [self.text(whole).encode()]

    def value(self, came: list[bytes]) -> Any:
        found = _NativeForm.value(self, came)
        if found is None:
            return None
        _, _, rate, samples = found["aud"]
        return np.array(samples, "f4"), rate


_proxies: dict[tuple[int, str, int, int], threading.Thread] = {}
_lock = threading.Lock()  # of the proxies


def keep_proxy(host: str, front: int, back: int) -> None:
    """The broker of requests, here or in another program; when that ends, here."""
    key = os.getpid(), host, front, back
    with _lock:
        if key not in _proxies:
            thread = threading.Thread(
                target=_proxy, args=(host, front, back), name="wrapyfi requests", daemon=True
            )
            _proxies[key] = thread
            thread.start()


def _proxy(host: str, front: int, back: int) -> None:
    while True:
        router, dealer = context().socket(zmq.ROUTER), context().socket(zmq.DEALER)
        try:
            router.bind(f"tcp://{host}:{front}")
            dealer.bind(f"tcp://{host}:{back}")
            zmq.proxy(router, dealer)
        except zmq.ZMQError as error:
            if error.errno not in (errno.EADDRINUSE, zmq.EADDRINUSE):
                return  # another computer's address, or the end
        finally:
            router.close(linger=0)
            dealer.close(linger=0)
        time.sleep(_PAUSE)


def _numbers(options: dict[str, Any]) -> tuple[str, int, int]:
    """Host, and the numbers for clients and for servers."""
    host, _, _ = _place(options)
    front = options.get("socket_req_port") or _variable("SOCKET_REQ_PORT", "5558")
    back = options.get("socket_rep_port") or "5559"
    return host, int(front), int(back)


class _Socket:
    """A REQ or REP whose waiting ends when it is closed."""

    def __init__(self, kind: int, address: str) -> None:
        self._socket = context().socket(kind)
        if kind == zmq.REQ:
            self._socket.setsockopt(zmq.REQ_RELAXED, 1)
            self._socket.setsockopt(zmq.REQ_CORRELATE, 1)
        self._socket.setsockopt(zmq.LINGER, 500)
        self._socket.setsockopt(zmq.MAXMSGSIZE, ZMQ_MESSAGE)
        self._socket.connect(address)
        self._closed = False
        self._lock = threading.Lock()  # of the socket

    def send(self, frames: list[bytes]) -> None:
        with self._lock:
            self._socket.send_multipart(frames)

    def receive(self, timeout: float | None) -> list[bytes]:
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            with self._lock:
                if self._closed:
                    raise yarpy.PortClosed("this was closed")
                if self._socket.poll(1000 * _PAUSE):
                    frames: list[bytes] = self._socket.recv_multipart()
                    return frames
            if deadline is not None and time.monotonic() > deadline:
                raise yarpy.Timeout(f"nothing came within {timeout} s")

    def close(self) -> None:
        self._closed = True
        with self._lock:
            self._socket.close()


class _Serving(_Socket):
    def __init__(self, side: Any) -> None:
        host, front, back = _numbers(side.options)
        if str(side.options.get("start_proxy_broker", "True")) != "False":
            keep_proxy(host, front, back)
        super().__init__(zmq.REP, f"tcp://{host}:{back}")

    def take(self) -> tuple[list[bytes], Callable[[Any], None]]:
        return self.receive(None), self._answer

    def _answer(self, found: Any) -> None:
        if not self._closed:
            self.send([b"null"] if isinstance(found, Failure) else found)


class _Asking(_Socket):
    def __init__(self, side: Any) -> None:
        host, front, _ = _numbers(side.options)
        super().__init__(zmq.REQ, f"tcp://{host}:{front}")

    def wait(self, seconds: float) -> bool:
        """Servers are not waited for: the broker keeps what is asked."""
        return True

    def ask(self, spelled: list[bytes], timeout: float | None) -> list[bytes]:
        self.send(spelled)
        return self.receive(timeout)


offer(
    Medium(
        "zeromq",
        {"NativeObject": _NativeForm, "Image": _PictureForm, "AudioChunk": _SoundForm},
        _Out,
        _In,
        {"NativeObject": _NativeForm, "Image": _PictureAnswer, "AudioChunk": _SoundAnswer},
        _Serving,
        _Asking,
    )
)
