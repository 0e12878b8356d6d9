"""FrameGrabber: a remote camera, C++ or Python, used like a local one.

    with FrameGrabber("/icub/cam/left") as eye:
        pixels = eye.image().array            # the next picture
        eye.features["brightness"] = 0.5

Rules: it has every member listed in `devices.frame_grabber.interface`, so it is itself a
camera. The camera starts sending when the first image is requested. Old images are dropped.

A camera of YARP 4 is asked the same as calls of its functions.

Source: frameGrabber_nwc_yarp of YARP 3.x and 4.0.
"""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping, Sequence
from contextlib import ExitStack
from typing import Any, Final

from yarpy import clock
from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.image import Image
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, RemoteProtocolError, Timeout
from yarpy.kits.devices.closeable import Closeable, local_prefix, prefix
from yarpy.kits.devices.frame_grabber.firewire import FUNCTIONS, RemoteRegisters
from yarpy.kits.devices.frame_grabber.interface import FEATURES
from yarpy.kits.devices.frame_grabber.responder import BUSES, MODES
from yarpy.kits.devices.frame_grabber.yarp4.requests import FunctionRequests
from yarpy.names.base import NameClient
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcClient

#: Seconds to wait for an answer or an image.
TIMEOUT: Final = 10.0


class FrameGrabber(Closeable):
    """The camera whose images come from the port `remote`.

    local: name of the client's own port; generated if empty.
    carrier: for the images, for example "mjpeg" where the network is slow. As of `Port.connect`.
    names: a name client, None for the default.
    Raises UnknownName, LinkClosed. Later, LocalProtocolError means that the camera refuses.
    """

    def __init__(
        self,
        remote: str,
        local: str = "",
        *,
        carrier: str = "",
        names: NameClient | None = None,
    ) -> None:
        self.remote = remote = prefix(remote)
        self._local = local_prefix(local, remote)
        self._carrier = carrier
        self.stamp = Stamp()
        self._functions: FunctionRequests | None = None
        self._newer = False  # it is of YARP 4
        with ExitStack() as resources:
            self._rpc = resources.enter_context(
                RpcClient(f"{remote}/rpc", name=f"{self._local}/rpc_client", names=names)
            )
            self._images = resources.enter_context(BufferedPort(self._local, names=names))
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<FrameGrabber {self.remote}>"

    def image(self, timeout: float = TIMEOUT) -> Image:
        """The next picture. Raises Timeout after `timeout` seconds, UnknownName, LinkClosed."""
        if not self._images.inputs:
            self._images.listen_to(self.remote, self._carrier)
        try:
            message = self._images.read(timeout)
        except Timeout as error:
            raise Timeout(
                f'no image came from "{self.remote}" for {timeout} s: is the camera on?'
            ) from error
        self.stamp = message.stamp or Stamp(self.stamp.count + 1, clock.now())
        return message.as_(Image)

    def __iter__(self) -> Iterator[Image]:
        """Pictures as they arrive."""
        while True:
            yield self.image()

    def timestamp(self) -> float:
        """Return the time when the last image was taken, seconds (of the camera's clock)."""
        return self.stamp.time

    def crop(self, left: int, top: int, right: int, bottom: int) -> Image:
        """A rectangle of the next picture, corners included."""
        corners = Bottle([left, top, right, bottom])
        return self._picture(self._send("fgi", "get", "crop", 0, corners))

    @property
    def resolution(self) -> tuple[int, int]:
        """Width and height, pixels."""
        width, height = self._get("res", 2)
        return int(width), int(height)

    @resolution.setter
    def resolution(self, size: tuple[int, int]) -> None:
        self._set("res", *map(int, size))

    @property
    def field_of_view(self) -> tuple[float, float]:
        """Horizontal and vertical, degrees."""
        horizontal, vertical = self._get("fov", 2)
        return float(horizontal), float(vertical)

    @field_of_view.setter
    def field_of_view(self, angles: tuple[float, float]) -> None:
        self._set("fov", *map(float, angles))

    @property
    def resolutions(self) -> list[tuple[int, int, float, str]]:
        """Supported modes: width, height, pictures per second, pixel code."""
        listed = self._get("conf", 1)[1:]
        rows = zip(*(listed[start::4] for start in range(4)), strict=False)
        return [(int(w), int(h), float(rate), str.__str__(code)) for w, h, rate, code in rows]

    @property
    def intrinsics(self) -> dict[str, Any]:
        """Focal lengths, distortion and so on, by name."""
        return dict(Property.from_bottle(self._get("intp", 1)[0]))

    @property
    def mirror(self) -> bool:
        """Return whether left and right are swapped."""
        return bool(self._get("mirr", 1)[0])

    @mirror.setter
    def mirror(self, mirrored: bool) -> None:
        self._set("mirr", int(mirrored))

    @property
    def description(self) -> tuple[str, str]:
        """The bus of the camera, and a text that says which camera it is."""
        bus, text = self._payload(self._send("fgc", "get", "camd"), 2)[:2]
        return BUSES[bus] if bus in range(len(BUSES)) else "unknown", str(text)

    @property
    def firewire(self) -> RemoteRegisters:
        """The registers of a camera at FireWire; others refuse each of them."""
        return RemoteRegisters(self._register)

    @property
    def features(self) -> Features:
        """Values by name (`FEATURES`): a number, or two."""
        return Features(self, "feat", "feat")

    @property
    def feature_modes(self) -> Features:
        """`auto` or `manual`, by name."""
        return Features(self, "mode", "auto")

    @property
    def feature_switches(self) -> Features:
        """The features that are on or off, by name."""
        return Features(self, "actv", "onof")

    def one_push(self, feature: str) -> None:
        """Let the camera adjust a feature automatically, once."""
        self._send("fgc", "set", "onep", _index(feature))

    # -- within -------------------------------------------------------------------------------

    def _send(self, *words: Any) -> list[Any]:
        request = Bottle(Vocab(word) if type(word) is str else word for word in words)
        if self._functions is None:
            functions = FunctionRequests(self.remote, self._rpc, TIMEOUT)
            self._newer = functions.is_there()
            self._functions = functions
        if self._newer:
            return self._functions.request(request)
        reply = self._rpc.call(request, timeout=TIMEOUT)
        found = reply if isinstance(reply, list) else [reply]
        if found and found[0] == "fail":
            why = f": {found[1]}" if len(found) > 1 else ""
            raise LocalProtocolError(f'"{self.remote}" refuses {request.to_text()}{why}')
        return found

    def _payload(self, reply: list[Any], count: int) -> list[Any]:
        if len(reply) < 3 + count or reply[2] != "is":
            raise RemoteProtocolError(f'"{self.remote}" answers {Bottle(reply).to_text()[:100]}')
        return reply[3:]

    def _get(self, item: str, count: int) -> list[Any]:
        return self._payload(self._send("visr", "get", item), count)

    def _set(self, item: str, *values: int | float) -> None:
        reply = self._send("visr", "set", item, *values)
        if reply[2:] != [1]:
            given = " ".join(map(str, values))
            raise LocalProtocolError(f'"{self.remote}" does not accept {item} {given}')

    def _register(self, name: str, numbers: Sequence[int]) -> list[int]:
        function = FUNCTIONS[name]
        reply = self._send("fgfw", function.word, *numbers)
        if reply == ["nak"]:
            raise LocalProtocolError(f'"{self.remote}" is no camera at FireWire')
        if not function.gives and reply != [1]:
            raise LocalProtocolError(f'"{self.remote}" does not accept {name}{(*numbers,)}')
        if len(reply) < function.gives or not all(isinstance(each, int) for each in reply):
            raise RemoteProtocolError(f'"{self.remote}" answers {Bottle(reply).to_text()[:100]}')
        return reply

    def _picture(self, reply: list[Any]) -> Image:
        payload = self._payload(reply, 1)[0]
        if not isinstance(payload, list):
            raise RemoteProtocolError(f'"{self.remote}" returns no image')
        return Image.from_wire(Bottle(payload).to_bytes())


class Features(MutableMapping[str, Any]):
    """Features of a remote camera: values, modes or switches, whichever `item` says."""

    def __init__(self, camera: FrameGrabber, item: str, question: str) -> None:
        self._camera = camera
        self._item = item
        self._question = question

    def __getitem__(self, feature: str) -> Any:
        if feature not in self:
            raise KeyError(f'"{self._camera.remote}" has no {feature}: iterate to see what it has')
        index = _index(feature)
        if self._item != "feat":
            value = self._ask("get", self._item, index)[0]
            if self._item == "actv":
                return bool(value)
            return MODES[value] if value in range(len(MODES)) else "unknown"
        try:
            return float(self._ask("get", "feat", index)[0])
        except LocalProtocolError:
            first, second = self._ask("get", "fea2", index)[:2]
            return float(first), float(second)

    def __setitem__(self, feature: str, value: Any) -> None:
        index = _index(feature)
        if self._item == "mode":
            self._camera._send("fgc", "set", "mode", index, MODES.index(value))
        elif self._item == "actv":
            self._camera._send("fgc", "set", "actv", index, int(value))
        elif isinstance(value, Sequence):
            self._camera._send("fgc", "set", "fea2", index, *map(float, value))
        else:
            self._camera._send("fgc", "set", "feat", index, float(value))

    def __delitem__(self, feature: str) -> None:
        raise TypeError("features of a camera cannot be deleted")

    def __contains__(self, feature: object) -> bool:
        if feature not in FEATURES:
            return False
        reply = self._camera._send("fgc", "has", self._question, FEATURES.index(str(feature)))
        return len(reply) > 4 and reply[4] == 1

    def __iter__(self) -> Iterator[str]:
        return iter([feature for feature in FEATURES if feature in self])

    def __len__(self) -> int:
        return sum(feature in self for feature in FEATURES)

    def _ask(self, *words: Any) -> list[Any]:
        return self._camera._payload(self._camera._send("fgc", *words), 1)


def _index(feature: str) -> int:
    if feature not in FEATURES:
        raise KeyError(f"{feature!r} is not one of {', '.join(FEATURES)}")
    return FEATURES.index(feature)
