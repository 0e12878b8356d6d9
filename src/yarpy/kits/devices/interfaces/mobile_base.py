"""MobileBase, Odometry2D: a base on wheels is driven, and tells where it thinks it is.

Source: INavigation2DVelocityActions and IOdometry2D of YARP 3.6 to 4.0.
"""

from __future__ import annotations

from yarpy.kits.devices.interfaces.place import Odometry, Velocity
from yarpy.kits.devices.network.model import Interface, call, published, taken
from yarpy.kits.thrift.kind import Nested


class MobileBase(Interface):
    """A base on wheels."""

    NWS, NWC = "mobileBaseVelocityControl_nws_yarp", "mobileBaseVelocityControl_nwc_yarp"
    FAKE = "fakeNavigation"
    RPC = "rpc:i"

    @taken("data:i", Velocity)
    @call("applyVelocityCommandRPC", cpp="applyVelocityCommand")
    def apply_velocity(self, x: float, y: float, theta: float, timeout: float = 0.1) -> None:
        """Drive at m/s ahead and to the left, turn at deg/s; stop after `timeout` seconds."""

    @call("getLastVelocityCommandRPC", cpp="getLastVelocityCommand")
    def last_velocity(self) -> tuple[float, float, float]:
        """Return what was commanded last: m/s ahead and to the left, deg/s."""
        raise NotImplementedError


class Odometry2D(Interface):
    """The odometry of a base."""

    NWS, NWC = "odometry2D_nws_yarp", "odometry2D_nwc_yarp"
    FAKE = "fakeOdometry2D"
    VIEW = "IOdometry2D"

    @published("odometry:o", cpp="getOdometry")
    def odometry(self) -> Nested[Odometry]:
        """Return where it is and how fast."""
        raise NotImplementedError

    @call("reset_odometry_RPC", cpp="resetOdometry")
    def reset_odometry(self) -> None:
        """Begin anew, at 0."""
