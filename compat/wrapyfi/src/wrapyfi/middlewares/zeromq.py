"""ZeroMQ, by pyzmq: topics at a broker, requests through another one.

    topics       XPUB at HOST:5555 for subscribers, XSUB at HOST:5556 for publishers
    requests     ROUTER at HOST:5558 for clients, DEALER at HOST:5559 for servers

Rules: brokers run in whichever program came first, and another one's takes over. A request has no
topic: all servers at one broker get whatever is asked there, in turn.
"""

from __future__ import annotations

import errno
import logging
import os
import threading
import time
from typing import Any

import numpy as np
import zmq

import yarpy
from wrapyfi.connect.clients import Client, Clients
from wrapyfi.connect.listeners import Listener, Listeners
from wrapyfi.connect.publishers import Publisher, Publishers
from wrapyfi.connect.servers import Server, Servers
from wrapyfi.middlewares._form import Native, Picture, Sound, asked, patience
from wrapyfi.utils.core_utils import SingletonOptimized
from yarpy.wrap import payload
from yarpy.wrap.zmq_broker import keep_ready
from yarpy.wrap.zmq_link import In, Out, context

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


class ZeroMQMiddlewarePubSub(metaclass=SingletonOptimized):
    """There is nothing to start or stop by hand; the class is there because programs name it."""

    @staticmethod
    def activate(**kwargs: Any) -> ZeroMQMiddlewarePubSub:
        return ZeroMQMiddlewarePubSub()

    @staticmethod
    def deinit() -> None:
        return None


class ZeroMQMiddlewareReqRep(ZeroMQMiddlewarePubSub):
    """The same for requests."""


# ------------------------------------------------------------------------------------ topics


class _Publisher(Publisher):
    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "tcp",
        should_wait: bool = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, out_topic, carrier, should_wait, **kwargs)
        self._options = kwargs
        self._out: Out | None = None

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        fresh = self._out is None
        if self._out is None:
            self._out = Out(self.out_topic, _broker(self._options)[1])
        if self.should_wait:
            if not self._out.wait(patience()):
                raise yarpy.Timeout(f'nobody listens to "{self.out_topic}"')
        elif fresh:
            self._out.wait(0.2)  # until the broker has told who is there already
        return self.check_establishment(True)

    def publish(self, obj: Any) -> None:
        if not self.established:
            self.establish()
        assert self._out is not None
        frames = self._frames(obj)
        if frames is not None:
            self._out.send(frames)

    def _frames(self, obj: Any) -> list[bytes] | None:
        raise NotImplementedError

    def close(self) -> None:
        if self._out is not None:
            self._out.close()
            self._out = None
        self.established = False


def _header() -> bytes:
    return f"{{timestamp:{time.time()}}}".encode()


@Publishers.register("NativeObject", "zeromq")
class ZeroMQNativeObjectPublisher(_Publisher):
    """Topic and JSON."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._native = Native(kwargs)

    def _frames(self, obj: Any) -> list[bytes] | None:
        return [self._native.text(obj).encode()]


@Publishers.register("Image", "zeromq")
class ZeroMQImagePublisher(ZeroMQNativeObjectPublisher):
    """Topic, a header, and JSON of the array or a JPEG file."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _frames(self, obj: Any) -> list[bytes] | None:
        if obj is None:
            return None
        array = self._picture.checked(obj)
        if self._picture.jpg:
            return [_header(), self._picture.file(array)]
        return [_header(), self._native.text(array).encode()]


@Publishers.register("AudioChunk", "zeromq")
class ZeroMQAudioChunkPublisher(ZeroMQNativeObjectPublisher):
    """Topic, a header, and JSON of chunk, channels, rate and samples."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._sound = Sound(kwargs)

    def _frames(self, obj: Any) -> list[bytes] | None:
        found = self._sound.checked(obj)
        if found is None:
            return None
        samples, rate = found
        whole = (len(samples), samples.shape[1], rate, self._sound.shaped(samples))
        return [_header(), self._native.text(whole).encode()]


class _Listener(Listener):
    #: what a listener gets when there is nothing
    nothing: Any = None

    def __init__(
        self,
        name: str,
        in_topic: str,
        carrier: str = "tcp",
        should_wait: bool = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, in_topic, carrier, should_wait, **kwargs)
        self._options = kwargs
        self._native = Native(kwargs)
        self._in: In | None = None

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        if self._in is None:
            self._in = In(self.in_topic, _broker(self._options)[0])
        return self.check_establishment(True)

    def listen(self) -> Any:
        if not self.established:
            self.establish()
        assert self._in is not None
        try:
            frames = self._in.receive(patience() if self.should_wait else 0.0)
        except yarpy.Timeout:
            if self.should_wait:
                raise
            return self.nothing
        return self._value(frames)

    def _value(self, frames: list[bytes]) -> Any:
        return _loaded(frames, self._native)

    def close(self) -> None:
        if self._in is not None:
            self._in.close()
            self._in = None
        self.established = False


def _loaded(frames: list[bytes], native: Native) -> Any:
    """A value: of Wrapyfi's text, or of a frame of yarpy."""
    titled = len(frames) == 2 and frames[0].startswith(b"{timestamp")
    data = frames[-1] if len(frames) == 1 or titled else b""
    if not data or data[:3] == payload.JPEG or payload.frame.is_frame(data):
        return payload.of_parts(frames).value
    return native.value(data)


@Listeners.register("NativeObject", "zeromq")
class ZeroMQNativeObjectListener(_Listener):
    """Any value."""


@Listeners.register("Image", "zeromq")
class ZeroMQImageListener(_Listener):
    """A picture."""

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _value(self, frames: list[bytes]) -> Any:
        if frames and frames[-1][:3] == payload.JPEG:
            return self._picture.of_file(frames[-1])
        return np.asarray(_loaded(frames, self._native))


@Listeners.register("AudioChunk", "zeromq")
class ZeroMQAudioChunkListener(_Listener):
    """Samples and rate; (None, rate) when there is nothing."""

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self.nothing = (None, Sound(kwargs).rate)

    def _value(self, frames: list[bytes]) -> Any:
        _, _, rate, samples = _loaded(frames, self._native)
        return samples, rate


# ------------------------------------------------------------------------------------ requests

_proxies: dict[tuple[int, str, int, int], threading.Thread] = {}
_lock = threading.Lock()  # of the proxies


def _keep_proxy(host: str, front: int, back: int) -> None:
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
        self._socket.connect(address)
        self._closed = False
        self._lock = threading.Lock()  # of the socket

    def send(self, data: bytes) -> None:
        with self._lock:
            self._socket.send(data)

    def receive(self, timeout: float | None) -> bytes:
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            with self._lock:
                if self._closed:
                    raise yarpy.PortClosed("this was closed")
                if self._socket.poll(1000 * _PAUSE):
                    data: bytes = self._socket.recv()
                    return data
            if deadline is not None and time.monotonic() > deadline:
                raise yarpy.Timeout(f"nothing came within {timeout} s")

    def close(self) -> None:
        self._closed = True
        with self._lock:
            self._socket.close()


class _Server(Server):
    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "tcp",
        out_topic_connect: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, out_topic, carrier, out_topic_connect, **kwargs)
        self._options = kwargs
        self._native = Native(kwargs)
        self._socket: _Socket | None = None

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        if self._socket is None:
            host, front, back = _numbers(self._options)
            if str(self._options.get("start_proxy_broker", "True")) != "False":
                _keep_proxy(host, front, back)
            self._socket = _Socket(zmq.REP, f"tcp://{host}:{back}")
        return self.check_establishment(True)

    def await_request(self, *args: Any, **kwargs: Any) -> tuple[list[Any], dict[str, Any]]:
        if not self.established:
            self.establish()
        assert self._socket is not None
        while True:
            data = self._socket.receive(None)
            try:
                return asked(self._native, self._native.value(data))
            except (ValueError, TypeError) as error:
                logging.error("[wrapyfi] a request that cannot be read: %s", error)
                self._socket.send(b"null")

    def reply(self, obj: Any) -> None:
        assert self._socket is not None
        try:
            data = b"null" if obj is None or isinstance(obj, Exception) else self._spelled(obj)
        except Exception:
            self._socket.send(b"null")  # whoever asked is not left waiting
            raise
        self._socket.send(data)

    def _spelled(self, obj: Any) -> bytes:
        return self._native.text(obj).encode()

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None
        self.established = False


@Servers.register("NativeObject", "zeromq")
class ZeroMQNativeObjectServer(_Server):
    """Replies with JSON."""


@Servers.register("Image", "zeromq")
class ZeroMQImageServer(_Server):
    """Replies with JSON of nested lists, or with a JPEG file."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _spelled(self, obj: Any) -> bytes:
        array = self._picture.checked(obj)
        if self._picture.jpg:
            return self._picture.file(array)
        return self._native.text({"img": array.tolist()}).encode()


@Servers.register("AudioChunk", "zeromq")
class ZeroMQAudioChunkServer(_Server):
    """Replies with JSON of chunk, channels, rate and nested lists."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._sound = Sound(kwargs)

    def _spelled(self, obj: Any) -> bytes:
        found = self._sound.checked(obj)
        if found is None:
            return b"null"
        samples, rate = found
        shaped = self._sound.shaped(samples).tolist()
        whole = [len(samples), samples.shape[1], rate, shaped]
        return self._native.text({"aud": whole}).encode()


class _Client(Client):
    def __init__(self, name: str, in_topic: str, carrier: str = "tcp", **kwargs: Any) -> None:
        super().__init__(name, in_topic, carrier, **kwargs)
        self._options = kwargs
        self._native = Native(kwargs)
        self._socket: _Socket | None = None

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        if self._socket is None:
            host, front, _ = _numbers(self._options)
            self._socket = _Socket(zmq.REQ, f"tcp://{host}:{front}")
        return self.check_establishment(True)

    def request(self, *args: Any, **kwargs: Any) -> Any:
        if not self.established:
            self.establish()
        assert self._socket is not None
        self._socket.send(self._native.text([args, kwargs]).encode())
        return self._value(self._socket.receive(patience()))

    def _value(self, data: bytes) -> Any:
        return self._native.value(data)

    def close(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None
        self.established = False


@Clients.register("NativeObject", "zeromq")
class ZeroMQNativeObjectClient(_Client):
    """Gets any value."""


@Clients.register("Image", "zeromq")
class ZeroMQImageClient(_Client):
    """Gets a picture."""

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _value(self, data: bytes) -> Any:
        if data[:3] == payload.JPEG:
            return self._picture.of_file(data)
        found = self._native.value(data)
        return None if found is None else np.array(found["img"], self._picture.dtype)


@Clients.register("AudioChunk", "zeromq")
class ZeroMQAudioChunkClient(_Client):
    """Gets samples and rate."""

    def _value(self, data: bytes) -> Any:
        found = self._native.value(data)
        if found is None:
            return None
        _, _, rate, samples = found["aud"]
        return np.array(samples, "f4"), rate
