"""ROS 2, by yarpy's own nodes over a router of Zenoh, or over DDS where RMW_IMPLEMENTATION names a
middleware of DDS. No ROS is needed.

Rules: the router is that of YARPY_ZENOH or ZENOH_SESSION_CONFIG_URI, the domain that of
ROS_DOMAIN_ID. Each publisher, listener, server and client is a node of its own, called as its class
and its address. Services are those of Wrapyfi's package of interfaces, whose definitions are
brought along; over DDS a server that fails cannot tell.
"""

from __future__ import annotations

import os
import re
import threading
import time
from functools import partial
from importlib.util import find_spec
from typing import Any

import yarpy
from wrapyfi.middlewares._arrivals import Arrivals, RequestQueue
from wrapyfi.middlewares._ros import (
    FieldedService,
    Interfaces,
    PictureForm,
    SoundForm,
    TextForm,
    ros_forms,
)
from wrapyfi.middlewares._side import Medium, Nothing, offer
from yarpy.kits.wrap.middleware import Failure
from yarpy.kits.wrap.value.spelling import failure, failure_of
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.key import domain
from yarpy.peers.ros2.message.library import default_library
from yarpy.peers.ros2.node.node import is_dds
from yarpy.peers.ros2.token import SERVER, SUBSCRIBER
from yarpy.peers.ros2.zenoh.participant import take_part

if not (find_spec("zenoh") and find_spec("xxhash")) and not find_spec("cyclonedds"):
    raise ImportError("it needs eclipse-zenoh and xxhash: pip install 'yarpy-wrapyfi[ros2]'")

_LOOK = 0.02  # seconds between looks who is there, over DDS

_PACKAGE = "wrapyfi_ros2_interfaces"
_AUDIO = f"{_PACKAGE}/ROS2AudioMessage"

default_library().sources.append(Interfaces())


class ROS2Middleware(Nothing):
    """Programs name it."""


def _load(name: str) -> Any:
    return default_library().message(name)


def _target(side: Any, topic: str, type_: str | None, kind: str = "msg") -> str:
    """A topic or service as something to connect to."""
    node = re.sub(r"[^A-Za-z0-9_]+", "_", str(side.__name__)).strip("_") or "wrapyfi"
    found = f"ros2{'+dds' if is_dds() else ''}+node.{node}_{id(side):x}://{topic.strip('/')}"
    if type_ is None:
        return found
    package, _, name = type_.partition("/")
    return f"{found}~{package}/{kind}/{name}"


class _Watch:
    """Waits for somebody else at a topic or service."""

    def __init__(self, topic: str, kind: str) -> None:
        self._topic = f"/{topic.strip('/')}"
        self._awaited = kind
        self._closed = threading.Event()
        self._dds = is_dds()
        self._part: Any = (POOL.take if self._dds else take_part)(domain(None))

    def wait(self, seconds: float) -> bool:
        if not self._dds:
            return bool(self._part.graph.wait(self._topic, self._awaited, timeout=seconds))
        name = f"rt{self._topic}" if self._awaited == SUBSCRIBER else f"rq{self._topic}Request"
        until = time.monotonic() + seconds
        while not self._closed.is_set():
            if any(found.topic_name == name for found in self._part.endpoints(SUBSCRIBER)):
                return True
            if time.monotonic() >= until:
                break
            time.sleep(_LOOK)
        return False

    def end(self) -> None:
        if not self._closed.is_set():
            self._closed.set()
            if self._dds:
                POOL.leave(self._part)
            else:
                self._part.close()


class _Out(_Watch):
    def __init__(self, side: Any) -> None:
        super().__init__(side.out_topic, SUBSCRIBER)
        kind = side.form.type
        self._kind = _load(kind) if isinstance(kind, str) else kind
        self._port = yarpy.BufferedPort("", strict=True)
        try:
            self._port.connect(_target(side, side.out_topic, self._kind._type))
        except BaseException:
            self.close()
            raise

    def send(self, spelled: Any) -> None:
        self._port.write(self._kind(spelled) if isinstance(spelled, str) else spelled)

    def close(self) -> None:
        self._port.close()
        self.end()


class _In(Arrivals):
    def __init__(self, side: Any) -> None:
        super().__init__(side, os.environ.get("WRAPYFI_ROS2_QUEUE_SIZE", 5))
        texts = side.form.type == TextForm.type

        def heard(message: Any) -> None:
            self.arrived(message.ros.data if texts else message.ros)

        self._port = yarpy.BufferedPort("", callback=heard)
        try:
            self._port.listen_to(_target(side, side.in_topic, side.form.type))
        except BaseException:
            self._port.close()
            raise

    def close(self) -> None:
        super().close()
        self._port.close()


# ------------------------------------------------------------------------------------ services


def _service(side: Any) -> tuple[str, FieldedService]:
    """The type of a service, and how it is asked."""
    word = {"NativeObject": "NativeObject", "AudioChunk": "Audio"}.get(side.kind)
    if word is None:
        word = "CompressedImage" if side.options.get("jpg") else "Image"
    name = f"{_PACKAGE}/ROS2{word}Service"
    return name, FieldedService(default_library().service(name))


class _Serving(RequestQueue):
    def __init__(self, side: Any) -> None:
        super().__init__(side.out_topic)
        name, self._service = _service(side)
        self._port = yarpy.RpcServer("", self._handle, register=False)
        try:
            self._port.listen_to(_target(side, side.out_topic, name, "srv"))
        except BaseException:
            self._port.close()
            raise

    def _handle(self, message: Any) -> Any:
        found = self.ask(self._service.text(message.ros))
        if found is None:
            found = Failure("ValueError", "it has no value")
        return failure(found) if isinstance(found, Failure) else self._service.answer(found)

    def close(self) -> None:
        super().close()
        self._port.close()


class _Asking(_Watch):
    def __init__(self, side: Any) -> None:
        super().__init__(side.in_topic, SERVER)
        name, self._service = _service(side)
        self._port = yarpy.RpcClient()
        try:
            self._port.connect(_target(side, side.in_topic, name, "srv"))
        except BaseException:
            self.close()
            raise

    def ask(self, spelled: Any, timeout: float | None) -> Any:
        message = self._port.ask(self._service.question(spelled), timeout)
        failed = None if message is None else failure_of(message.value)
        if failed is not None:
            raise failed.error()
        response = getattr(message, "ros", None)
        if response is None:
            raise yarpy.LinkClosed(f'"{self._topic}" failed, and gave no answer')
        return self._service.content(response)

    def close(self) -> None:
        self._port.close()
        self.end()


_FORMS = ros_forms(_load, _AUDIO, "ROS2Message")

offer(
    Medium(
        "ros2",
        _FORMS,
        _Out,
        _In,
        {
            "NativeObject": TextForm,
            "Image": partial(PictureForm, load=_load),
            "AudioChunk": partial(SoundForm, load=_load, type_=_AUDIO),
        },
        _Serving,
        _Asking,
    )
)
