"""Transforms: frames that are kept by a server, C++ or Python, used like own ones.

    with TransformClient() as frames:
        frames.place("camera", "head", (0.1, 0, 0), constant=True)
        print(frames.pose("camera", "base"))

Rules: those of `frames`. Each question is answered with what the server knows at that moment.

Source: frameTransformSet_nwc_yarp and frameTransformGet_nwc_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, Final

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.data.yarp4 import to_yarp4
from yarpy.errors import DecodeError, LocalProtocolError, RemoteProtocolError
from yarpy.kits.devices.closeable import Closeable, local_prefix, prefix
from yarpy.kits.devices.status import OK, reason, split
from yarpy.kits.devices.transforms.frames import pose, transform
from yarpy.kits.devices.transforms.functions import FrameTransformStorageSetRPC, Transform
from yarpy.kits.thrift.client import client_class
from yarpy.kits.thrift.payload import Payload
from yarpy.names.base import NameClient
from yarpy.port.rpc import RpcClient

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0


class TransformClient(Closeable):
    """The frames of the server whose ports begin with `remote`.

    local: prefix of the client's own ports; generated if empty.
    names: a name client, None for the default.
    Raises UnknownName, LinkClosed; later Timeout, LocalProtocolError (it refuses).
    """

    def __init__(
        self,
        remote: str = "/frameTransformServer",
        local: str = "",
        *,
        names: NameClient | None = None,
    ) -> None:
        self.remote = remote = prefix(remote)
        local = local_prefix(local, remote)
        with ExitStack() as resources:
            self._set, self._get = (
                resources.enter_context(
                    RpcClient(
                        f"{remote}/frameTransform{what}_nws_yarp/thrift",
                        name=f"{local}/{what.lower()}",
                        names=names,
                    )
                )
                for what in ("Set", "Get")
            )
            client = client_class(FrameTransformStorageSetRPC)(self._set, TIMEOUT)
            version = client.remote_version()
            self._newer = version is not None and version[1] >= 4
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<TransformClient {self.remote}>"

    def place(
        self,
        frame: str,
        parent: str,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        *,
        constant: bool = False,
    ) -> None:
        """`frame` is there, seen from `parent`: metres, and a quaternion x y z w. What is not
        constant has to be told again and again. Raises ValueError, LocalProtocolError."""
        made = transform(frame, parent, position, rotation, constant, clock.now())
        self._tell("setTransformRPC", made.to_bottle())

    def remove(self, frame: str, parent: str) -> None:
        """Forget where it is. Raises LocalProtocolError if that was not known."""
        self._tell("deleteTransformRPC", parent, frame)

    def clear(self) -> None:
        """Forget everything."""
        self._tell("clearAllRPC")

    def all(self) -> list[Transform]:
        """Return all transforms that are known."""
        code, rest = split(self._ask(self._get, ["getTransformsRPC"]))
        if code != OK:
            raise LocalProtocolError(f'"{self.remote}" tells no transforms: {reason(code)}')
        try:
            return [Transform.from_bottle(each) for each in (rest[0] if rest else ())]
        except (TypeError, DecodeError) as error:
            raise RemoteProtocolError(f'"{self.remote}" tells no transforms: {error}') from error

    def frames(self) -> list[str]:
        """The names of all frames."""
        return sorted({name for each in self.all() for name in (each.source, each.target)})

    def pose(self, frame: str, reference: str) -> NDArray[Any]:
        """Return the pose of `frame`, seen from `reference`: a 4 x 4 matrix. Raises LookupError."""
        return pose({each.target: each for each in self.all()}, frame, reference)

    def _tell(self, function: str, *arguments: Any) -> None:
        code, _ = split(self._ask(self._set, [function, *arguments]))
        if code != OK:
            raise LocalProtocolError(f'"{self.remote}" refuses {function}: {reason(code)}')

    def _ask(self, port: RpcClient, words: list[Any]) -> list[Any]:
        data = Bottle(words).to_bytes()
        message = port.ask(Payload(to_yarp4(data) if self._newer else data), TIMEOUT)
        return [] if message is None else message.as_(Bottle)
