"""FrameWriterServer: pictures that come to a port are shown by your device: a screen, a file.

    class Screen:
        def show(self, image):                        # a yarpy.Image, RGB
            ...

    FrameWriterServer("/screen", Screen())

    <name>        pictures, each is shown
    <name>/rpc    answers nothing: [fail]

Rules: pictures come one at a time, in order; others than RGB are converted, where C++ refuses them.
What the device raises is logged, and the next picture is shown.

Source: frameWriter_nws_yarp of YARP 4.0, whose other end is any port that sends pictures.
"""

from __future__ import annotations

import threading
from contextlib import ExitStack

from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Message


class FrameWriterServer(Closeable):
    """Shows pictures by `device`, which has show(image).

    name: the port that reads pictures, for example `/robot/screen`.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no show().
    """

    def __init__(self, name: str, device: object, *, names: NameClient | None = None) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._complain = DeviceErrorLog(name)
        self._screen = Access(device, 0, self._complain, threading.Lock())
        if not self._screen.has("show"):
            raise ValueError(f"{name}: the device needs show(image)")
        with ExitStack() as resources:
            resources.enter_context(
                RpcServer(f"{name}/rpc", lambda message: Bottle([Vocab("fail")]), names=names)
            )
            port = BufferedPort(name, callback=self._take, names=names, port_type="yarp/image")
            resources.enter_context(port)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<FrameWriterServer {self.name}>"

    def _take(self, message: Message) -> None:
        try:
            self._screen.ask("show", message.as_(Image).converted("rgb"))
        except Refused:
            return  # it was logged
        except (DecodeError, ValueError) as error:
            self._complain("a picture", error)
