"""Localization2D: where a robot is in a map.

Source: ILocalization2D of YARP 3.6 to 4.0.
"""

from __future__ import annotations

from typing import Annotated, Final

import yarpy
from yarpy.kits.devices.interfaces.place import Odometry, Place
from yarpy.kits.devices.network.model import Interface, call, published
from yarpy.kits.thrift.kind import External, Nested, vocab

#: What `localization_status` says: not yet localized, localized, error.
STATUS: Final = ("locn", "locy", "err")

Covariance = Annotated[yarpy.Matrix, External("yarp::sig::Matrix", python="yarpy.Matrix")]


class Localization2D(Interface):
    """The interface of a device that knows where the robot is."""

    NWS, NWC = "localization2D_nws_yarp", "localization2D_nwc_yarp"
    FAKE = "fakeLocalizer"
    VIEW = "ILocalization2D"

    @call("start_localization_service_RPC", cpp="startLocalizationService")
    def start_localization(self) -> None:
        """Begin to look for the robot."""

    @call("stop_localization_service_RPC", cpp="stopLocalizationService")
    def stop_localization(self) -> None:
        """Look for it no longer."""

    @call("get_localization_status_RPC", cpp="getLocalizationStatus")
    def localization_status(self) -> vocab:
        """Return one of `STATUS`."""
        raise NotImplementedError

    @call("get_estimated_poses_RPC", cpp="getEstimatedPoses")
    def estimates(self) -> list[Place]:
        """Return the places where it may be."""
        raise NotImplementedError

    @published("streaming:o")
    @call("get_current_position1_RPC", cpp="getCurrentPosition")
    def position(self) -> Nested[Place]:
        """Return where it is."""
        raise NotImplementedError

    @call("get_current_position2_RPC", cpp="getCurrentPosition")
    def position_with_covariance(self) -> tuple[Nested[Place], Covariance]:
        """Return where it is, and the covariance of x, y and theta, 3 x 3."""
        raise NotImplementedError

    @published("odometry:o")
    @call("get_estimated_odometry_RPC", cpp="getEstimatedOdometry")
    def odometry(self) -> Nested[Odometry]:
        """Return how it has moved."""
        raise NotImplementedError

    @call("set_initial_pose1_RPC", cpp="setInitialPose")
    def locate(self, place: Nested[Place]) -> None:
        """Tell where it is."""

    @call("set_initial_pose2_RPC", cpp="setInitialPose")
    def locate_with_covariance(self, place: Nested[Place], covariance: Covariance) -> None:
        """Tell where it is, and how sure that is."""
