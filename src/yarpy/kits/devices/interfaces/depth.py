"""DepthCamera: pictures, and how far everything in them is; RGBD in C++.

Rules: pictures come from `rgbImage:o`, distances in metres, float32, from `depthImage:o`; both have
the same time. `colour_*` and `depth_*` are about their lenses; features have the numbers of
`devices.FEATURES`. YARP 3 asks in words (`network.words`). A single picture cannot be asked for,
which C++ can by hand alone: its clients read the ports.

Source: IRGBDSensor, IRgbVisualParams, IDepthVisualParams and IFrameGrabberControls of YARP 3.9 and
4.0.
"""

from __future__ import annotations

from typing import ClassVar

import yarpy
from yarpy.kits.devices.interfaces.media import Configuration, Table, Transform, When
from yarpy.kits.devices.network.model import Interface, call, published
from yarpy.kits.thrift.kind import Nested, i32

#: What `status` says; the index here is the number on the wire.
STATES = (*("not ready", "standby", "in use", "colour error", "depth error", "error", "timeout"),)


class DepthCamera(Interface):
    """A camera that measures distances."""

    NWS, NWC = "RGBDSensor_nws_yarp", "RGBDSensor_nwc_yarp"
    FAKE = "fakeDepthCamera"
    VIEW = "IRGBDSensor"
    RPC = "rpc:i"
    WORDS = "is"
    # The version of the protocol, which clients of C++ 3 ask for first.
    TOLD: ClassVar = {"rgdb get prot": (1, 0)}

    @published("rgbImage:o", cpp="getRgbImage")
    def colour(self) -> yarpy.Image:
        """Return the next picture; None if there is none."""
        raise NotImplementedError

    @published("depthImage:o", cpp="getDepthImage")
    def depth(self) -> yarpy.Image:
        """Return the distances of its pixels in metres; None if there are none."""
        raise NotImplementedError

    @call("getExtrinsicParamRPC", cpp="getExtrinsicParam", words="rgdb get ext")
    def extrinsics(self) -> Transform:
        """Return where the depth camera is, seen from the other: 4 x 4."""
        raise NotImplementedError

    @call("getLastErrorMsgRPC", cpp="getLastErrorMsg", words="rgdb get mess")
    def last_error(self) -> tuple[str, Nested[When]]:
        """Return what went wrong last, and when."""
        raise NotImplementedError

    @call("getSensorStatusRPC", cpp="getSensorStatus", words="rgdb get stat")
    def status(self) -> i32:
        """Return how it is: a number of `STATES`."""
        raise NotImplementedError

    @call("getRgbWidthRPC", cpp="getRgbWidth", words="visr get w")
    def colour_width(self) -> i32:
        """Return the width of pictures."""
        raise NotImplementedError

    @call("getRgbHeightRPC", cpp="getRgbHeight", words="visr get h")
    def colour_height(self) -> i32:
        """Return the height of pictures."""
        raise NotImplementedError

    @call(
        "getRgbSupportedConfigurationsRPC",
        cpp="getRgbSupportedConfigurations",
        words="visr get conf",
    )
    def configurations(self) -> list[Configuration]:
        """Return all sizes that it can have."""
        raise NotImplementedError

    @call("getRgbResolutionRPC", cpp="getRgbResolution", words="visr get res")
    def colour_resolution(self) -> tuple[i32, i32]:
        """Return width and height of pictures."""
        raise NotImplementedError

    @call("setRgbResolutionRPC", cpp="setRgbResolution", words="visr set res")
    def resize_colour(self, width: i32, height: i32) -> None:
        """Change them."""

    @call("getRgbFOVRPC", cpp="getRgbFOV", words="visr get fov")
    def colour_field_of_view(self) -> tuple[float, float]:
        """Return the angles that it sees, in degrees: from side to side, and from top to bottom."""
        raise NotImplementedError

    @call("setRgbFOVRPC", cpp="setRgbFOV", words="visr set fov")
    def widen_colour(self, horizontal: float, vertical: float) -> None:
        """Change them."""

    @call("getRgbIntrinsicParamRPC", cpp="getRgbIntrinsicParam", words="visr get intp")
    def colour_intrinsics(self) -> Table:
        """Return the parameters of its lens: `focalLengthX` ..."""
        raise NotImplementedError

    @call("getRgbMirroringRPC", cpp="getRgbMirroring", words="visr get mirr")
    def colour_mirrored(self) -> bool:
        """Return whether left and right are exchanged."""
        raise NotImplementedError

    @call("setRgbMirroringRPC", cpp="setRgbMirroring", words="visr set mirr")
    def mirror_colour(self, mirror: bool) -> None:
        """Exchange them, or do not."""

    @call("getDepthWidthRPC", cpp="getDepthWidth", words="visd get w")
    def depth_width(self) -> i32:
        """Return the width of distances."""
        raise NotImplementedError

    @call("getDepthHeightRPC", cpp="getDepthHeight", words="visd get h")
    def depth_height(self) -> i32:
        """Return the height of distances."""
        raise NotImplementedError

    @call("getDepthResolutionRPC", cpp="getDepthResolution", words="visd get res")
    def depth_resolution(self) -> tuple[i32, i32]:
        """Return width and height of distances."""
        raise NotImplementedError

    @call("setDepthResolutionRPC", cpp="setDepthResolution", words="visd set res")
    def resize_depth(self, width: i32, height: i32) -> None:
        """Change them."""

    @call("getDepthFOVRPC", cpp="getDepthFOV", words="visd get fov")
    def depth_field_of_view(self) -> tuple[float, float]:
        """Return the angles that it sees, in degrees: from side to side, and from top to bottom."""
        raise NotImplementedError

    @call("setDepthFOVRPC", cpp="setDepthFOV", words="visd set fov")
    def widen_depth(self, horizontal: float, vertical: float) -> None:
        """Change them."""

    @call("getDepthIntrinsicParamRPC", cpp="getDepthIntrinsicParam", words="visd get intp")
    def depth_intrinsics(self) -> Table:
        """Return the parameters of its lens: `focalLengthX` ..."""
        raise NotImplementedError

    @call("getDepthMirroringRPC", cpp="getDepthMirroring", words="visd get mirr")
    def depth_mirrored(self) -> bool:
        """Return whether left and right are exchanged."""
        raise NotImplementedError

    @call("setDepthMirroringRPC", cpp="setDepthMirroring", words="visd set mirr")
    def mirror_depth(self, mirror: bool) -> None:
        """Exchange them, or do not."""

    @call("getDepthAccuracyRPC", cpp="getDepthAccuracy", words="visd get acrc")
    def accuracy(self) -> float:
        """Return how exact distances are, in metres at one metre."""
        raise NotImplementedError

    @call("setDepthAccuracyRPC", cpp="setDepthAccuracy", words="visd set acrc")
    def change_accuracy(self, accuracy: float) -> None:
        """Change that."""

    @call("getDepthClipPlanesRPC", cpp="getDepthClipPlanes", words="visd get clip")
    def clip_planes(self) -> tuple[float, float]:
        """Return the least and the largest distance that is measured, in metres."""
        raise NotImplementedError

    @call("setDepthClipPlanesRPC", cpp="setDepthClipPlanes", words="visd set clip")
    def change_clip_planes(self, near: float, far: float) -> None:
        """Change them."""

    @call("getCameraDescriptionRPC", cpp="getCameraDescription", words="fgc get camd")
    def description(self) -> tuple[i32, str]:
        """Return how it is connected (1 FireWire, 2 USB), and what it is."""
        raise NotImplementedError

    @call("hasFeatureRPC", cpp="hasFeature", words="fgc has feat")
    def has_feature(self, feature: i32) -> bool:
        """Return whether it has a feature."""
        raise NotImplementedError

    @call("setFeature1RPC", cpp="setFeature", words="fgc set feat")
    def change_feature(self, feature: i32, value: float) -> None:
        """Change a feature, mostly 0 to 1."""

    @call("getFeature1RPC", cpp="getFeature", words="fgc get feat")
    def feature(self, feature: i32) -> float:
        """Return the value of a feature."""
        raise NotImplementedError

    @call("setFeature2RPC", cpp="setFeature", words="fgc set fea2")
    def change_pair(self, feature: i32, first: float, second: float) -> None:
        """Change a feature of two values."""

    @call("getFeature2RPC", cpp="getFeature", words="fgc get fea2")
    def feature_pair(self, feature: i32) -> tuple[float, float]:
        """Return the values of a feature that has two."""
        raise NotImplementedError

    @call("hasOnOffRPC", cpp="hasOnOff", words="fgc has onof")
    def has_switch(self, feature: i32) -> bool:
        """Return whether a feature can be switched off."""
        raise NotImplementedError

    @call("setActiveRPC", cpp="setActive", words="fgc set actv")
    def switch(self, feature: i32, on: bool) -> None:
        """Switch a feature on or off."""

    @call("getActiveRPC", cpp="getActive", words="fgc get actv")
    def active(self, feature: i32) -> bool:
        """Return whether a feature is on."""
        raise NotImplementedError

    @call("hasAutoRPC", cpp="hasAuto", words="fgc has auto")
    def has_automatic(self, feature: i32) -> bool:
        """Return whether a feature can adjust itself."""
        raise NotImplementedError

    @call("hasManualRPC", cpp="hasManual", words="fgc has man")
    def has_manual(self, feature: i32) -> bool:
        """Return whether a feature can be adjusted."""
        raise NotImplementedError

    @call("hasOnePushRPC", cpp="hasOnePush", words="fgc has onep")
    def has_one_push(self, feature: i32) -> bool:
        """Return whether a feature can adjust itself once."""
        raise NotImplementedError

    @call("setModeRPC", cpp="setMode", words="fgc set mode")
    def change_mode(self, feature: i32, mode: i32) -> None:
        """Adjust a feature by hand (1) or automatically (2)."""

    @call("getModeRPC", cpp="getMode", words="fgc get mode")
    def mode(self, feature: i32) -> i32:
        """Return how a feature is adjusted."""
        raise NotImplementedError

    @call("setOnePushRPC", cpp="setOnePush", words="fgc set onep")
    def push(self, feature: i32) -> None:
        """Adjust a feature automatically, once."""
