"""ROS 1, by yarpy's own node: topics, services and parameters. No ROS is needed.

Rules: the master is that of ROS_MASTER_URI. One node for a process, called `wrapyfi_<pid>`, or as
`ros_kwargs` says, which counts when the first of them is opened. Properties are parameters; with
`persistent=False` they end with their publisher. JPEG files are for topics alone.
"""

from __future__ import annotations

import logging
import os
import threading
import time
from functools import partial
from typing import Any

import yarpy
import yarpy.peers.ros
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
from yarpy.peers.ros.master import DEFAULT_URI
from yarpy.peers.ros.message.library import default_library

_AUDIO = "wrapyfi_ros_interfaces/ROSAudio"
_PAUSE = 0.05  # seconds between two looks at a parameter

default_library().catalogue.sources.append(Interfaces())

_nodes: dict[int, tuple[yarpy.ros.Node, list[object]]] = {}
_lock = threading.Lock()  # of the nodes


class ROSMiddleware(Nothing):
    """Programs name it."""


def _load(name: str) -> Any:
    return default_library().message(name)


class _Use:
    """One use of the node of this process."""

    def __init__(self, options: dict[str, Any]) -> None:
        known = dict(options.get("ros_kwargs") or {})
        name = str(known.get("node_name", "wrapyfi"))
        if known.get("anonymous", True):
            name += f"_{os.getpid()}"
        with _lock:
            if os.getpid() not in _nodes:
                master = os.environ.get("ROS_MASTER_URI") or DEFAULT_URI
                _nodes[os.getpid()] = yarpy.ros.Node(name, master=master), []
            self.node, users = _nodes[os.getpid()]
            users.append(self)

    def leave(self) -> None:
        with _lock:
            node, users = _nodes.get(os.getpid(), (None, []))
            if self not in users:
                return
            users.remove(self)
            if users or node is None:
                return
            del _nodes[os.getpid()]
        node.close()


# ------------------------------------------------------------------------------------ topics


class _Out(_Use):
    def __init__(self, side: Any) -> None:
        super().__init__(side.options)
        try:
            self._port = self.node.publisher(side.out_topic, side.form.type)
        except BaseException:
            self.leave()
            raise

    def wait(self, seconds: float) -> bool:
        return self._port.wait_for_outputs(1, seconds)

    def send(self, spelled: Any) -> None:
        self._port.write(self._port.type(spelled) if isinstance(spelled, str) else spelled)

    def close(self) -> None:
        self._port.close()
        self.leave()


class _In(Arrivals, _Use):
    def __init__(self, side: Any) -> None:
        Arrivals.__init__(self, side, os.environ.get("WRAPYFI_ROS_QUEUE_SIZE", 5))
        _Use.__init__(self, side.options)
        texts = side.form.type == TextForm.type
        try:
            self._port = self.node.subscriber(
                side.in_topic,
                side.form.type,
                lambda came: self.arrived(came.data if texts else came),
            )
        except BaseException:
            self.leave()
            raise

    def close(self) -> None:
        super().close()
        self._port.close()
        self.leave()


class _PropertyForm:
    """A parameter: numbers, texts, lists, and dicts of them."""

    nothing: Any = None

    def __init__(self, options: dict[str, Any]) -> None:
        pass

    def spelled(self, obj: Any) -> Any:
        return obj

    def value(self, came: Any) -> Any:
        return came


class _PropertyOut(_Use):
    def __init__(self, side: Any) -> None:
        super().__init__(side.options)
        self._name = side.out_topic
        self._persistent = side.options.get("persistent", True)

    def wait(self, seconds: float) -> bool:
        return True

    def send(self, spelled: Any) -> None:
        self.node.set_param(self._name, spelled)

    def close(self) -> None:
        try:
            if not self._persistent:
                self.node.delete_param(self._name)
        except yarpy.YarpError as error:
            logging.debug("[wrapyfi] %s is not deleted: %s", self._name, error)
        finally:
            self.leave()


class _PropertyIn(_Use):
    def __init__(self, side: Any) -> None:
        super().__init__(side.options)
        self._name = side.in_topic
        self._closed = threading.Event()

    def wait(self, seconds: float) -> bool:
        return True

    def receive(self, timeout: float | None) -> Any:
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self._closed.is_set():
            found = self.node.get_param(self._name, None)
            if found is not None:
                return found
            if deadline is not None and time.monotonic() >= deadline:
                raise yarpy.Timeout(f'nobody has set "{self._name}"')
            self._closed.wait(_PAUSE)
        raise yarpy.PortClosed("this was closed")

    def close(self) -> None:
        self._closed.set()
        self.leave()


def _out(side: Any) -> Any:
    return _PropertyOut(side) if side.kind == "Properties" else _Out(side)


def _into(side: Any) -> Any:
    return _PropertyIn(side) if side.kind == "Properties" else _In(side)


# ------------------------------------------------------------------------------------ services


class _BareService:
    """A service of Wrapyfi's own: the halves are messages, and no file defines it."""

    def __init__(self, name: str, md5sum: str, response: str) -> None:
        self.name = f"wrapyfi_services/{name}"
        self.md5sum = md5sum
        self.Request = _load(TextForm.type)
        self.Response = _load(response)
        self.full_text = f"{self.Request._full_text}\n---\n{self.Response._full_text}"
        self.kind = self

    def question(self, text: str) -> Any:
        return self.Request(text)

    def request(self, question: Any) -> Any:
        """As a service of a file: the question is made already."""
        return question

    def text(self, question: Any) -> str:
        return str(question.data)

    def answer(self, spelled: Any) -> Any:
        return self.Response(spelled) if isinstance(spelled, str) else spelled

    def content(self, response: Any) -> Any:
        return response.data if response._type == TextForm.type else response


def _service(side: Any) -> Any:
    if side.kind == "AudioChunk":
        return FieldedService(default_library().service(f"{_AUDIO}Service"))
    if side.kind == "Image":
        return _BareService("ROSImage", "f720f2021b4bbbe86b0f93b08906381c", "sensor_msgs/Image")
    return _BareService("ROSNativeObject", "46a550fd1ca640b396e26ebf988aed7b", TextForm.type)


class _Serving(RequestQueue, _Use):
    def __init__(self, side: Any) -> None:
        RequestQueue.__init__(self, side.out_topic)
        _Use.__init__(self, side.options)
        self._service = _service(side)
        try:
            self._port = self.node.service(side.out_topic, self._service.kind, self._handle)
        except BaseException:
            self.leave()
            raise

    def _handle(self, question: Any) -> Any:
        found = self.ask(self._service.text(question))
        if found is None:
            found = Failure("ValueError", "it has no value")
        if isinstance(found, Failure):
            raise found.error()
        return self._service.answer(found)

    def close(self) -> None:
        super().close()
        self._port.close()
        self.leave()


class _Asking(_Use):
    def __init__(self, side: Any) -> None:
        super().__init__(side.options)
        self._topic = side.in_topic
        self._service = _service(side)

    def wait(self, seconds: float) -> bool:
        return self.node.wait_for_service(self._topic, seconds)

    def ask(self, spelled: Any, timeout: float | None) -> Any:
        question = self._service.question(spelled)
        return self._service.content(
            self.node.call(self._topic, self._service.kind, question, timeout=timeout)
        )

    def close(self) -> None:
        self.leave()


class _RawPicture(PictureForm):
    """A picture of an answer."""

    def __init__(self, options: dict[str, Any]) -> None:
        super().__init__({**options, "jpg": False}, _load)


offer(
    Medium(
        "ros",
        {
            **ros_forms(_load, f"{_AUDIO}Message", "ROSMessage"),
            "Properties": _PropertyForm,
        },
        _out,
        _into,
        {
            "NativeObject": TextForm,
            "Image": _RawPicture,
            "AudioChunk": partial(SoundForm, load=_load, type_=f"{_AUDIO}Message"),
        },
        _Serving,
        _Asking,
    )
)
