"""The interface of a camera: the methods and attributes of a frame grabber.

    class Eye:
        def image(self):                              # needed
            return self.camera.read()                 # (height, width, 3) uint8: red, green, blue

    FrameGrabberServer("/robot/eye", Eye())

Rules: as for control boards (`devices.control_board.interface`): your class inherits nothing
and defines only what it supports. `image` is called only while somebody is watching; it may wait
for the camera, and may return the same array every time. Settings are attributes, to which the
server assigns. Any exception is logged, and the next image is tried.

Source: interfaces of YARP 3.x behind frameGrabber_nws_yarp.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from yarpy.data.sig.image import Image
    from yarpy.kits.devices.frame_grabber.firewire import Registers

#: What a camera can adjust; the index here is the number in the protocol.
FEATURES = (
    *("brightness", "exposure", "sharpness", "white_balance", "hue", "saturation", "gamma"),
    *("shutter", "gain", "iris", "focus", "temperature", "trigger", "trigger_delay"),
    *("white_shading", "frame_rate", "zoom", "pan", "tilt", "optical_filter", "capture_size"),
    *("capture_quality", "mirror"),
)


class Camera(Protocol):
    """The minimum for a frame grabber; `FrameGrabberLike` lists the rest."""

    def image(self) -> Image | NDArray[Any] | None:
        """The next picture: an array that `yarpy.Image` takes, or an Image. None: none now."""


class FrameGrabberLike(Camera, Protocol):
    """Everything a frame grabber can have. For reading; classes need not inherit it."""

    def timestamp(self) -> float:
        """Return the time when the last image was taken, in seconds; default: when `image`
        returned."""

    resolution: tuple[int, int]  # width and height in pixels; default: the image's
    resolutions: Sequence[tuple[int, int, float, str]]  # supported: width, height, Hz, pixel code
    field_of_view: tuple[float, float]  # horizontal and vertical, degrees
    intrinsics: Mapping[str, Any]  # focalLengthX, principalPointX, distortionModel ...
    mirror: bool

    features: MutableMapping[str, Any]
    """Values by name (see FEATURES), mostly 0 to 1: a number, or two (white balance)."""
    feature_modes: MutableMapping[str, str]
    """`auto` or `manual`, for the features that can be either."""
    feature_switches: MutableMapping[str, bool]
    """On or off, for the features that can be either."""

    def one_push(self, feature: str) -> object:
        """Adjust a feature automatically, once."""

    description: tuple[str, str]  # "usb", "firewire" or "unknown"; which camera it is
    firewire: Registers  # of a camera at FireWire
