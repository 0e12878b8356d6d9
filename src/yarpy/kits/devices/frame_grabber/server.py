"""FrameGrabberServer: serve your camera on the ports of a YARP frame grabber.

    <name>          its images; RPC clients are answered here too
    <name>/rpc      requests and replies (`responder`); those of YARP 4 too (`yarp4`)

Rules: no image is grabbed while nobody is watching. A slow receiver misses images.

Source: frameGrabber_nws_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

import threading
from contextlib import ExitStack
from typing import Any, Final, Protocol

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.frame_grabber.interface import Camera
from yarpy.kits.devices.frame_grabber.responder import FrameGrabberResponder
from yarpy.kits.devices.frame_grabber.yarp4.server import Functions
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Message

#: How a request of YARP 4 begins: the words of YARP 3 have four letters at most.
_FUNCTION: Final = ("get", "set", "has")


class Viewer(Protocol):
    """Sees the images, as a port of YARP does or in another system."""

    @property
    def outputs(self) -> object:
        """Whoever watches; what is false where nobody does."""

    def write(self, image: Image, stamp: Stamp, /) -> object:
        """Show an image with its number and time."""


class FrameGrabberServer(Closeable):
    """Serves `device` (see `devices.frame_grabber.interface`) to viewers and other programs.

    name: the port of the images, for example `/robot/cam/left`.
    period: seconds between images.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer; ValueError if the device has no image().
    `images` is the port of the images, `viewers` are all that see them, the port first.
    """

    def __init__(
        self,
        name: str,
        device: Camera,
        period: float = 0.033,
        *,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self.device = device
        self._camera = Access(device, 0, DeviceErrorLog(name), threading.Lock())
        if not self._camera.has("image"):
            raise ValueError(f"{name}: the device needs image(), which returns the next picture")
        self._responder = FrameGrabberResponder(self._camera, self._grab, name)
        self._functions = Functions(self._responder, name)
        self._stamp = Stamp()
        with ExitStack() as resources:
            self._rpc = resources.enter_context(RpcServer(f"{name}/rpc", self._answer, names=names))
            self.images = resources.enter_context(
                BufferedPort(name, callback=self._reply, names=names, port_type="yarp/image")
            )
            self.viewers: list[Viewer] = [self.images]
            self._publisher = Publisher(name, period, self._publish)
            resources.callback(self._publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<FrameGrabberServer {self.name}>"

    def _grab(self) -> Image:
        """The next image, in its own memory. Raises Refused."""

        def take(image: Any) -> Image | None:
            import numpy as np

            found = image()
            if found is None or isinstance(found, Image):
                return found
            # A copy, because the camera refills its array while this is being sent.
            given = np.asarray(found)
            copy = self.images.prepare(given.shape, given.dtype)
            copy[...] = given
            return Image(copy)

        image = self._camera.use("image", take)
        if image is None or not image.width or not image.height:
            raise Refused("the camera returned no image")
        return image

    def _answer(self, message: Message) -> object:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return Bottle([Vocab("fail")])
        if request and str(request[0]).startswith(_FUNCTION) and len(request[0]) > 4:
            return self._functions(message)
        return self._responder.answer(request)

    def _reply(self, message: Message) -> None:
        if message.wants_reply:
            message.reply(self._answer(message))

    def _publish(self) -> None:
        viewers = [viewer for viewer in self.viewers if viewer.outputs]
        if not viewers:
            return
        try:
            image = self._grab()
        except Refused:
            return  # no image, or an error, which was logged
        when = self._camera.ask("timestamp") if self._camera.has("timestamp") else clock.now()
        self._responder.size = image.width, image.height
        self._stamp = self._stamp.next(float(when))
        for viewer in viewers:
            viewer.write(image, self._stamp)
