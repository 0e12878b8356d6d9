"""YARP, by ports of yarpy. No C++ is needed; programs with C++ YARP take part.

    publisher     a port TOPIC, which is subscribed to TOPIC:out: who opens that is fed
    listener      a port TOPIC:in<n>, connected as soon as TOPIC is there, and again when it returns
    server        a port TOPIC that answers; client: a port TOPIC:in<n> that asks it

Rules: bytes are those of Wrapyfi on C++ YARP 3.5. A server that fails says so, `[fail] why`.
"""

from __future__ import annotations

import logging
import queue
import random
import time
from base64 import b64decode, b64encode
from typing import Any

import numpy as np

import yarpy
from wrapyfi.connect.clients import Client, Clients
from wrapyfi.connect.listeners import Listener, Listeners
from wrapyfi.connect.publishers import Publisher, Publishers
from wrapyfi.connect.servers import Server, Servers
from wrapyfi.middlewares._form import Native, Picture, Sound, asked, patience
from wrapyfi.utils.core_utils import SingletonOptimized
from yarpy.network.connection import ask_server
from yarpy.wrap.follower import Follower
from yarpy.wrap.middleware import Failure
from yarpy.wrap.npy import from_npy, to_npy
from yarpy.wrap.spelling import failure, failure_of, frame_of

_CODES = {(True, False): "rgb", (False, False): "mono", (True, True): "rgb.", (False, True): "dec"}


class YarpMiddleware(metaclass=SingletonOptimized):
    """There is nothing to start or stop; the class is there because programs name it."""

    @staticmethod
    def activate(**kwargs: Any) -> YarpMiddleware:
        return YarpMiddleware()

    @staticmethod
    def deinit() -> None:
        return None


def _subscribe(topic: str, target: str, persistent: bool) -> None:
    """Let the name server connect `topic` to `target` whenever that is there."""
    if not persistent:
        return
    try:
        ask_server(None, ["subscribe", topic, target])
    except yarpy.YarpError as error:
        logging.debug("[wrapyfi] %s is not subscribed to %s: %s", target, topic, error)


def _own(topic: str) -> str:
    return f"{topic}:in{random.randrange(100_000)}"


# ------------------------------------------------------------------------------------ publishers


class _Publisher(Publisher):
    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "tcp",
        should_wait: bool = True,
        persistent: bool = True,
        out_topic_connect: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, out_topic, carrier, should_wait, **kwargs)
        self.persistent = persistent
        self.out_topic_connect = out_topic_connect or f"{out_topic}:out"
        self._port: Any = None

    def _open(self) -> Any:
        return yarpy.BufferedPort(self.out_topic)

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        if self._port is None:
            self._port = self._open()
            _subscribe(self.out_topic, self.out_topic_connect, self.persistent)
        if self.should_wait and not self._port.wait_for_outputs(1, patience()):
            raise yarpy.Timeout(f'nobody listens to "{self.out_topic}"')
        return self.check_establishment(True)

    def publish(self, obj: Any) -> None:
        if not self.established:
            self.establish()
        value = self._spelled(obj)
        if value is not None:
            self._port.write(value)

    def _spelled(self, obj: Any) -> Any:
        raise NotImplementedError

    def close(self) -> None:
        if self._port is not None:
            self._port.close()
            self._port = None
        self.established = False


@Publishers.register("NativeObject", "yarp")
class YarpNativeObjectPublisher(_Publisher):
    """A Bottle of one text."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._native = Native(kwargs)

    def _spelled(self, obj: Any) -> Any:
        return [self._native.text(obj)]


@Publishers.register("Image", "yarp")
class YarpImagePublisher(_Publisher):
    """An Image, or a Bottle of one text for JPEG files."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _spelled(self, obj: Any) -> Any:
        if obj is None:
            return None
        array = self._picture.checked(obj)
        if self._picture.jpg:
            data = np.array(self._picture.file(array))
            return [b64encode(to_npy(data)).decode()]
        return yarpy.Image(array, _CODES[self._picture.rgb, self._picture.fp])


@Publishers.register("AudioChunk", "yarp")
class YarpAudioChunkPublisher(_Publisher):
    """A Sound; every connection gets one of zeros first, which tells listeners the size."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._sound = Sound(kwargs)
        self._greeted: set[str] = set()

    def _open(self) -> Any:
        return yarpy.BufferedPort(self.out_topic, strict=True)

    def _spelled(self, obj: Any) -> Any:
        found = self._sound.checked(obj)
        if found is None:
            return None
        samples, rate = found
        present = {link.target for link in self._port.outputs}
        if present - self._greeted:  # nobody minds a moment of silence
            self._port.write(_spelled_sound(np.zeros_like(samples), rate))
        self._greeted = present
        return _spelled_sound(samples, rate)


def _spelled_sound(samples: Any, rate: int) -> Any:
    values = (np.clip(samples, -1.0, 1.0).T * 32767).astype("<i2")
    return yarpy.Sound(values, rate).to_bottle("3.5")


@Publishers.register("Properties", "yarp")
class YarpPropertiesPublisher(_Publisher):
    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise NotImplementedError("Properties are parameters of ROS: YARP has none")


# ------------------------------------------------------------------------------------ listeners


class _Listener(Listener):
    strict = False

    def __init__(
        self,
        name: str,
        in_topic: str,
        carrier: str = "tcp",
        should_wait: bool = True,
        persistent: bool = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, in_topic, carrier, should_wait, **kwargs)
        self._port: Any = None
        self._follower: Follower | None = None

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        if self._port is None:
            self._port = yarpy.BufferedPort(_own(self.in_topic), strict=self.strict)
            self._follower = Follower(self._port, self.in_topic, self.carrier or "tcp")
        assert self._follower is not None
        if self.should_wait and not self._follower.wait(patience()):
            raise yarpy.Timeout(f'nobody publishes "{self.in_topic}"')
        return self.check_establishment(self.should_wait or self._follower.connected)

    def listen(self) -> Any:
        if not self.established and not self.establish():
            return None
        message = self._port.read(patience()) if self.should_wait else self._port.poll()
        return None if message is None else self._value(message)

    def _value(self, message: yarpy.Message) -> Any:
        raise NotImplementedError

    def close(self) -> None:
        if self._follower is not None:
            self._follower.close()
            self._follower = None
        if self._port is not None:
            self._port.close()
            self._port = None
        self.established = False


@Listeners.register("NativeObject", "yarp")
class YarpNativeObjectListener(_Listener):
    """Any message: a text of Wrapyfi, a frame of yarpy, or what YARP's programs send."""

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self._native = Native(kwargs)

    def _value(self, message: yarpy.Message) -> Any:
        return _native_value(message, self._native)


def _native_value(message: yarpy.Message, native: Native) -> Any:
    framed = frame_of(message)
    if framed is not None:
        return framed.value
    value = message.value
    if isinstance(value, list) and len(value) == 1:
        value = value[0]
    if not isinstance(value, str):
        return message.value
    return native.value(value)


@Listeners.register("Image", "yarp")
class YarpImageListener(_Listener):
    """A picture with the pixels that are declared, whichever pixels the sender has."""

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _value(self, message: yarpy.Message) -> Any:
        picture = self._picture
        if picture.jpg and message.spelling == "binary" and not _is_picture(message):
            text = message.as_(str)
            return picture.of_file(from_npy(b64decode(text)).tobytes())
        image = message.as_(yarpy.Image)
        code = _CODES[picture.rgb, picture.fp]
        # Wrapyfi says rgb and sends what it has; only another kind of picture is converted.
        return picture.checked(image.converted(code).array).copy()


def _is_picture(message: yarpy.Message) -> bool:
    return isinstance(message.value, yarpy.Image)


@Listeners.register("AudioChunk", "yarp")
class YarpAudioChunkListener(_Listener):
    """Every chunk, in order; the first one if it is all zeros tells only the size."""

    strict = True

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self._sound = Sound(kwargs)
        self._first = True

    def listen(self) -> Any:
        if not self.established and not self.establish():
            return None
        while True:
            message = self._port.read(patience()) if self.should_wait else self._port.poll()
            if message is None:
                return None
            sound = message.as_(yarpy.Sound)
            first, self._first = self._first, False
            if not first or sound.array.any():
                return self._chunk(sound)
            if self._sound.rate <= 0:
                self._sound.rate = sound.frequency

    def _chunk(self, sound: yarpy.Sound) -> Any:
        samples = self._sound.shaped(sound.array.T.astype("f4") / 32767)
        return samples, (self._sound.rate if self._sound.rate > 0 else sound.frequency)


@Listeners.register("Properties", "yarp")
class YarpPropertiesListener(_Listener):
    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise NotImplementedError("Properties are parameters of ROS: YARP has none")


# ------------------------------------------------------------------------------------ servers


class _Server(Server):
    """Requests wait in a queue until the program's loop takes them."""

    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "tcp",
        out_topic_connect: str | None = None,
        persistent: bool = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, out_topic, carrier, out_topic_connect, **kwargs)
        self._native = Native(kwargs)
        self._asked: queue.Queue[Any] = queue.Queue()
        self._answered: queue.Queue[Any] | None = None
        self._port: Any = None

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        if self._port is None:
            self._port = yarpy.RpcServer(self.out_topic, self._handle)
        return self.check_establishment(True)

    def _handle(self, message: yarpy.Message) -> Any:
        args, kwargs = asked(self._native, _native_value(message, self._native))
        answered: queue.Queue[Any] = queue.Queue()
        self._asked.put((args, kwargs, answered))
        found = answered.get()
        if isinstance(found, Exception):
            return failure(Failure.of(found))
        return [self._spelled(found)]

    def _spelled(self, obj: Any) -> str:
        return self._native.text(obj)

    def await_request(self, *args: Any, **kwargs: Any) -> tuple[list[Any], dict[str, Any]]:
        if not self.established:
            self.establish()
        found = self._asked.get()
        if found is None:
            raise yarpy.PortClosed(f'"{self.out_topic}" was closed')
        found_args, found_kwargs, self._answered = found
        return found_args, found_kwargs

    def reply(self, obj: Any) -> None:
        if self._answered is not None:
            self._answered.put(obj)
            self._answered = None

    def close(self) -> None:
        self._asked.put(None)
        self.reply(yarpy.PortClosed("the server was closed"))
        if self._port is not None:
            self._port.close()
            self._port = None
        self.established = False


@Servers.register("NativeObject", "yarp")
class YarpNativeObjectServer(_Server):
    """Replies with a Bottle of one text."""


@Servers.register("Image", "yarp")
class YarpImageServer(_Server):
    """Replies with the array as a text."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _spelled(self, obj: Any) -> str:
        return self._native.text(None if obj is None else self._picture.checked(obj))


@Servers.register("AudioChunk", "yarp")
class YarpAudioChunkServer(_Server):
    """Replies with chunk, channels, rate and samples as a text."""

    def __init__(self, name: str, out_topic: str, **kwargs: Any) -> None:
        super().__init__(name, out_topic, **kwargs)
        self._sound = Sound(kwargs)

    def _spelled(self, obj: Any) -> str:
        found = None if obj is None else self._sound.checked(obj)
        if found is None:
            return self._native.text(None)
        samples, rate = found
        shaped = self._sound.shaped(samples)
        return self._native.text((len(samples), samples.shape[1], rate, shaped))


# ------------------------------------------------------------------------------------ clients


class _Client(Client):
    def __init__(
        self,
        name: str,
        in_topic: str,
        carrier: str = "tcp",
        persistent: bool = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, in_topic, carrier, **kwargs)
        self._native = Native(kwargs)
        self._port: Any = None

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        limit = patience()
        deadline = None if limit is None else time.monotonic() + limit
        while self._port is None:
            try:
                self._port = yarpy.RpcClient(
                    self.in_topic, name=_own(self.in_topic), carrier=self.carrier or "tcp"
                )
            except (yarpy.UnknownName, yarpy.LinkClosed):
                if deadline is not None and time.monotonic() > deadline:
                    raise
                time.sleep(0.1)
        return self.check_establishment(True)

    def request(self, *args: Any, **kwargs: Any) -> Any:
        if not self.established:
            self.establish()
        message = self._port.ask([self._native.text([args, kwargs])], patience())
        failed = None if message is None else failure_of(message)
        if failed is not None:
            raise failed.error()
        if message is None or message.value in ([], ""):
            raise yarpy.LinkClosed(f'"{self.in_topic}" failed, and gave no answer')
        return self._value(_native_value(message, self._native))

    def _value(self, value: Any) -> Any:
        return value

    def close(self) -> None:
        if self._port is not None:
            self._port.close()
            self._port = None
        self.established = False


@Clients.register("NativeObject", "yarp")
class YarpNativeObjectClient(_Client):
    """Gets any value."""


@Clients.register("Image", "yarp")
class YarpImageClient(_Client):
    """Gets a picture."""

    def __init__(self, name: str, in_topic: str, **kwargs: Any) -> None:
        super().__init__(name, in_topic, **kwargs)
        self._picture = Picture(kwargs)

    def _value(self, value: Any) -> Any:
        return None if value is None else self._picture.checked(value)


@Clients.register("AudioChunk", "yarp")
class YarpAudioChunkClient(_Client):
    """Gets samples and rate."""

    def _value(self, value: Any) -> Any:
        if value is None:
            return None
        _, _, rate, samples = value
        return samples, rate
