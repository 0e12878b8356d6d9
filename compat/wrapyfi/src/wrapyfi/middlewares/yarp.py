"""YARP, by ports of yarpy. No C++ is needed; programs with C++ YARP take part.

    publisher     a port TOPIC, which is subscribed to TOPIC:out: who opens that is fed
    listener      a port TOPIC:in<n>, connected as soon as TOPIC is there, and again when it returns
    server        a port TOPIC that answers; client: a port TOPIC:in<n> that asks it

Rules: bytes are those of Wrapyfi on C++ YARP 3.5. A server that fails says so, `[fail] why`.
"""

from __future__ import annotations

import logging
import random
import time
from base64 import b64decode, b64encode
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

import yarpy
from wrapyfi.middlewares._form import Native, Picture, Sound
from wrapyfi.middlewares._side import SKIP, Medium, Nothing, offer
from yarpy.kits.wrap.follower import Follower
from yarpy.kits.wrap.middleware import Failure
from yarpy.kits.wrap.value.npy import from_npy, to_npy
from yarpy.kits.wrap.value.spelling import failure, failure_of, frame_of
from yarpy.network.asking import ask_server

OPENING = 60.0  # seconds for a busy name server; programs of Wrapyfi know no limit there
_CODES = {(True, False): "rgb", (False, False): "mono", (True, True): "rgb.", (False, True): "dec"}


class YarpMiddleware(Nothing):
    """Programs name it."""


# ------------------------------------------------------------------------------------ topics


class _NativeForm(Native):
    """A Bottle of one text; what comes may be a frame of yarpy, or what programs of YARP send."""

    nothing: Any = None

    def spelled(self, obj: Any) -> Any:
        return [self.text(obj)]

    def value(self, came: yarpy.Message) -> Any:
        framed = frame_of(came)
        if framed is not None:
            return framed.value
        value = came.value
        if isinstance(value, list) and len(value) == 1:
            value = value[0]
        return self.of_text(value) if isinstance(value, str) else came.value


class _PictureForm(Picture):
    """An Image, or a Bottle of one text for JPEG files; listeners get the pixels they declare."""

    nothing: Any = None

    def spelled(self, obj: Any) -> Any:
        if obj is None:
            return None
        array = self.checked(obj)
        if self.jpg:
            return [b64encode(to_npy(np.array(self.file(array)))).decode()]
        return yarpy.Image(array, _CODES[self.rgb, self.fp])

    def value(self, came: yarpy.Message) -> Any:
        if self.jpg and came.spelling == "binary" and not isinstance(came.value, yarpy.Image):
            return self.of_file(from_npy(b64decode(came.as_(str))).tobytes())
        # Wrapyfi says rgb and sends what it has; only another kind of picture is converted.
        image = came.as_(yarpy.Image).converted(_CODES[self.rgb, self.fp])
        array = self.checked(image.array)
        # It belongs to the listener; bytes that came by a socket are nobody else's already.
        return array if array.flags.writeable else array.copy()


class _SoundForm(Sound):
    """A Sound. The first one of a connection is all zeros, and tells only the size."""

    nothing: Any = None

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(options)
        self._first = True

    def spelled(self, obj: Any) -> Any:
        return self.checked(obj)

    def value(self, came: yarpy.Message) -> Any:
        sound = came.as_(yarpy.Sound)
        first, self._first = self._first, False
        if first and not sound.array.any():
            if self.rate <= 0:
                self.rate = sound.frequency
            return SKIP
        samples = self.shaped(sound.array.T.astype("f4") / 32767)
        return samples, (self.rate if self.rate > 0 else sound.frequency)


def _spelled_sound(samples: Any, rate: int) -> Any:
    values = (np.clip(samples, -1.0, 1.0).T * 32767).astype("<i2")
    return yarpy.Sound(values, rate).to_bottle("3.5")


class _Out:
    def __init__(self, side: Any) -> None:
        self._port = yarpy.BufferedPort(
            side.out_topic, strict=side.kind == "AudioChunk", timeout=OPENING
        )
        self._greeted: set[str] = set()
        target = side.options.get("out_topic_connect") or f"{side.out_topic}:out"
        if not side.options.get("persistent", True):
            return
        try:  # the name server connects them whenever the target is there
            ask_server(None, ["subscribe", side.out_topic, target])
        except yarpy.YarpError as error:
            logging.debug("[wrapyfi] %s is not subscribed: %s", target, error)

    def wait(self, seconds: float) -> bool:
        return self._port.wait_for_outputs(1, seconds)

    def send(self, spelled: Any) -> None:
        if isinstance(spelled, tuple):
            samples, rate = spelled
            present = {link.target for link in self._port.outputs}
            if present - self._greeted:  # nobody minds a moment of silence
                self._port.write(_spelled_sound(np.zeros_like(samples), rate))
            self._greeted = present
            spelled = _spelled_sound(samples, rate)
        self._port.write(spelled)

    def close(self) -> None:
        self._port.close()


def _own(topic: str) -> str:
    return f"{topic}:in{random.randrange(100_000)}"


class _In:
    def __init__(self, side: Any) -> None:
        self._port = yarpy.BufferedPort(
            _own(side.in_topic), strict=side.kind == "AudioChunk", timeout=OPENING
        )
        self._follower = Follower(self._port, side.in_topic, side.carrier)

    def wait(self, seconds: float) -> bool:
        return self._follower.wait(seconds)

    def receive(self, timeout: float | None) -> yarpy.Message:
        if timeout != 0:
            return self._port.read(timeout)
        message = self._port.poll()
        if message is None:
            raise yarpy.Timeout("nothing came")
        return message

    def close(self) -> None:
        self._follower.close()
        self._port.close()


# ------------------------------------------------------------------------------------ requests


class _PictureAnswer(_NativeForm):
    """The array as a text."""

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(options)
        self._picture = Picture(options)

    def spelled(self, obj: Any) -> Any:
        return super().spelled(None if obj is None else self._picture.checked(obj))

    def value(self, came: yarpy.Message) -> Any:
        value = super().value(came)
        return None if value is None else self._picture.checked(value)


class _SoundAnswer(_NativeForm):
    """Chunk, channels, rate and samples as a text."""

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__(options)
        self._sound = Sound(options)

    def spelled(self, obj: Any) -> Any:
        return super().spelled(self._sound.row(obj))

    def value(self, came: yarpy.Message) -> Any:
        value = super().value(came)
        if value is None:
            return None
        _, _, rate, samples = value
        return samples, rate


class _Serving:
    """A port that the program's thread reads itself, and so answers without another one."""

    def __init__(self, side: Any) -> None:
        self._port = yarpy.Port(side.out_topic, timeout=OPENING)

    def take(self) -> tuple[yarpy.Message, Callable[[Any], None]]:
        message = self._port.read()
        return message, partial(_give, message)

    def close(self) -> None:
        self._port.close()


def _give(message: yarpy.Message, found: Any) -> None:
    """Answer; nobody is to be told where the client has left, or wants no answer."""
    if message.answer is not None:
        try:
            message.reply(failure(found) if isinstance(found, Failure) else found)
        except (yarpy.LinkClosed, yarpy.LocalProtocolError):
            pass


class _Asking:
    def __init__(self, side: Any) -> None:
        self._topic = side.in_topic
        self._carrier = side.carrier or "tcp"
        self._port: Any = None

    def wait(self, seconds: float) -> bool:
        if self._port is None:
            try:
                self._port = yarpy.RpcClient(
                    self._topic, name=_own(self._topic), carrier=self._carrier
                )
            except (yarpy.UnknownName, yarpy.LinkClosed):
                time.sleep(min(seconds, 0.1))
        return self._port is not None

    def ask(self, spelled: Any, timeout: float | None) -> yarpy.Message:
        message = self._port.ask(spelled, timeout)
        value = None if message is None else message.value
        failed = failure_of(value)
        if failed is not None:
            raise failed.error()
        if message is None or value in ([], ""):
            raise yarpy.LinkClosed(f'"{self._topic}" failed, and gave no answer')
        return message

    def close(self) -> None:
        if self._port is not None:
            self._port.close()


offer(
    Medium(
        "yarp",
        {"NativeObject": _NativeForm, "Image": _PictureForm, "AudioChunk": _SoundForm},
        _Out,
        _In,
        {"NativeObject": _NativeForm, "Image": _PictureAnswer, "AudioChunk": _SoundAnswer},
        _Serving,
        _Asking,
    )
)
