"""TransformServer: a store of frames that all programs of a network share.

    <name>/frameTransformSet_nws_yarp/thrift   takes transforms
    <name>/frameTransformGet_nws_yarp/thrift   gives all of them
    <name>/frameTransformGet_nws_yarp/tf:o     sends all of them, every period

Rules: those of `frames`. Readers and askers of YARP 4 get its form. What cannot be taken is
answered with [err5] (which is a failure to YARP 3, too), and the log says why.

Source: frameTransformServer of YARP 3.x and 4.0.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from struct import pack
from typing import Any, Final

from yarpy.data.value import LIST, VOCAB32
from yarpy.data.yarp4 import to_yarp4
from yarpy.kits.devices.closeable import Closeable, prefix
from yarpy.kits.devices.declared import Status
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.devices.status import FAILED, OK
from yarpy.kits.devices.transforms.frames import Frames
from yarpy.kits.devices.transforms.functions import (
    FrameTransformStorageGetRPC,
    FrameTransformStorageSetRPC,
    Transform,
    Transforms,
)
from yarpy.kits.thrift.payload import Payload
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.port.dialects import Dialects
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcServer
from yarpy.wire.message import Encoded

log = logger("yarpy.devices")

#: A status as a list of its own, and as YARP 3.10 has it.
_NESTED: Final = pack("<iii", LIST, 1, VOCAB32)
_PLAIN: Final = pack("<i", VOCAB32)


class TransformServer(Closeable):
    """Serves `frames`, a store of its own.

    name: prefix of the ports.
    period: seconds between messages.
    expiry: seconds after which what is not constant is forgotten.
    names: a name client, None for the default.
    Raises AddressError (a name is in use), NoNameServer.
    """

    def __init__(
        self,
        name: str = "/frameTransformServer",
        period: float = 0.02,
        *,
        expiry: float = 0.2,
        names: NameClient | None = None,
    ) -> None:
        self.name = name = prefix(name)
        self.frames = Frames(expiry)
        get = f"{name}/frameTransformGet_nws_yarp"
        with ExitStack() as resources:
            resources.enter_context(
                RpcServer(
                    f"{name}/frameTransformSet_nws_yarp/thrift", Take(self.frames), names=names
                )
            )
            stream = resources.enter_context(BufferedPort(f"{get}/tf:o", names=names))
            self._readers = Dialects(stream)
            give = Give(self.frames, self._readers.is_yarp4)
            resources.enter_context(RpcServer(f"{get}/thrift", give, names=names))
            publisher = Publisher(name, period, self._publish)
            resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<TransformServer {self.name}>"

    def _publish(self) -> None:
        if not self._readers:
            return
        data = bytes(Transforms(Status(OK), self.frames.all()).to_wire()[0])
        self._readers.write(lambda: Encoded(plain(data)), lambda: Encoded(to_yarp4(data)))


class Take(FrameTransformStorageSetRPC):
    """Takes transforms. A status alone has the same bytes in YARP 3.10 and 4.0."""

    def __init__(self, frames: Frames) -> None:
        self._frames = frames

    def _tried(self, act: Callable[[], object]) -> Status:
        try:
            done = act()
        except ValueError as error:
            log.info("a transform is not taken: %s", error)
            return Status(FAILED)
        return Status(FAILED if done is False else OK)

    def setTransformsRPC(self, transforms: list[Transform]) -> Status:
        """Frames are there, seen from others: all of these, or none."""
        return self._tried(lambda: self._frames.add(transforms))

    def setTransformRPC(self, transform: Transform) -> Status:
        """A frame is there, seen from another."""
        return self._tried(lambda: self._frames.add([transform]))

    def deleteTransformRPC(self, source: str, target: str) -> Status:
        """Forget where a frame is."""
        return self._tried(lambda: self._frames.remove(target, source))

    def clearAllRPC(self) -> Status:
        """Forget all."""
        return self._tried(self._frames.clear)


class Give(FrameTransformStorageGetRPC):
    """Gives all transforms. `is_yarp4`: whether a reader of the stream is of YARP 4."""

    def __init__(self, frames: Frames, is_yarp4: Callable[[str], bool]) -> None:
        self._frames = frames
        self._reads_yarp4 = is_yarp4

    def __call__(self, message: Any) -> Any:
        """Answer a message."""
        source = message.source
        # C++ names both ports alike, and listens before it asks.
        listener = f"{source.removesuffix('/thrift')}/tf:i"
        if not self._is_yarp4(source) and self._reads_yarp4(listener):
            self._note(source, True)
        answer = super().__call__(message)
        if isinstance(answer, Payload) and not self._is_yarp4(source):
            return Payload(plain(bytes(answer.data)))
        return answer

    def getTransformsRPC(self) -> Transforms:
        """Return all transforms that are known."""
        return Transforms(Status(OK), self._frames.all())


def plain(data: bytes) -> bytes:
    """An answer with the status as YARP 3.10 has it, without a list around it."""
    return data[:8] + _PLAIN + data[20:] if data[8:20] == _NESTED else data
