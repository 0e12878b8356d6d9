"""Navigation2D: a robot that goes to places.

Source: INavigation2D of YARP 3.6 to 4.0.
"""

from __future__ import annotations

from math import inf
from typing import Final

from yarpy.kits.devices.interfaces.grid import Grid
from yarpy.kits.devices.interfaces.place import Path, Place
from yarpy.kits.devices.network.model import Interface, call
from yarpy.kits.thrift.kind import Nested, vocab

#: What `status` says: idle, preparing, moving, waiting for an obstacle, arrived, aborted, failing,
#: paused, thinking, error.
STATUS: Final = (
    "idle", "prep", "movg", "wait", "rech", "abrt", "fail", "paus", "thnk", "err",
)  # fmt: skip


class Navigation2D(Interface):
    """The interface of what drives the robot to places. `which`: `glob` or `loca`, of the map or
    around the robot."""

    NWS, NWC = "navigation2D_nws_yarp", "navigation2D_nwc_yarp"
    FAKE = "fakeNavigation"
    VIEW = "INavigation2D"

    @call("goto_target_by_absolute_location_RPC", cpp="gotoTargetByAbsoluteLocation")
    def go(self, place: Nested[Place]) -> None:
        """Go to a place."""

    @call("goto_target_by_absolute_location_and_set_name_RPC")
    def go_named(self, place: Nested[Place], name: str) -> None:
        """Go to a place that has a name."""

    @call("goto_target_by_relative_location1_RPC", cpp="gotoTargetByRelativeLocation")
    def go_by(self, x: float, y: float) -> None:
        """Go so many metres ahead and to the left."""

    @call("goto_target_by_relative_location2_RPC", cpp="gotoTargetByRelativeLocation")
    def go_and_turn_by(self, x: float, y: float, theta: float) -> None:
        """Go so many metres, then turn by so many degrees."""

    @call("follow_path_RPC", cpp="followPath")
    def follow(self, path: Nested[Path]) -> None:
        """Go along a path (YARP 3.10 and later)."""

    @call("stop_navigation_RPC", cpp="stopNavigation")
    def stop(self) -> None:
        """Go no further."""

    @call("suspend_navigation_RPC", cpp="suspendNavigation")
    def suspend(self, seconds: float = inf) -> None:
        """Pause."""

    @call("resume_navigation_RPC", cpp="resumeNavigation")
    def resume(self) -> None:
        """Go on."""

    @call("recompute_current_navigation_path_RPC", cpp="recomputeCurrentNavigationPath")
    def plan_again(self) -> None:
        """Look for another way to the same place."""

    @call("get_navigation_status_RPC", cpp="getNavigationStatus")
    def status(self) -> vocab:
        """Return one of `STATUS`."""
        raise NotImplementedError

    @call("get_absolute_location_of_current_target_RPC", cpp="getAbsoluteLocationOfCurrentTarget")
    def target(self) -> Nested[Place]:
        """Return the place where it goes."""
        raise NotImplementedError

    @call("get_relative_location_of_current_target_RPC", cpp="getRelativeLocationOfCurrentTarget")
    def target_from_here(self) -> tuple[float, float, float]:
        """Return the same seen from the robot: metres ahead, to the left, degrees."""
        raise NotImplementedError

    @call("get_name_of_current_target_RPC", cpp="getNameOfCurrentTarget")
    def target_name(self) -> str:
        """Return the name of that place; "" if it has none."""
        raise NotImplementedError

    @call("get_all_navigation_waypoints_RPC", cpp="getAllNavigationWaypoints")
    def waypoints(self, which: vocab) -> Nested[Path]:
        """Return the places between."""
        raise NotImplementedError

    @call("get_current_nav_waypoint_RPC", cpp="getCurrentNavigationWaypoint")
    def waypoint(self) -> Nested[Place]:
        """Return the next of them."""
        raise NotImplementedError

    @call("get_current_navigation_map_RPC", cpp="getCurrentNavigationMap")
    def current_map(self, which: vocab) -> Nested[Grid]:
        """Return the map that is used."""
        raise NotImplementedError

    @call("apply_velocity_command_RPC", cpp="applyVelocityCommand")
    def apply_velocity(self, x: float, y: float, theta: float, timeout: float = 0.1) -> None:
        """Drive at m/s ahead and to the left, turn at deg/s; stop after `timeout` seconds."""

    @call("get_last_velocity_command_RPC", cpp="getLastVelocityCommand")
    def last_velocity(self) -> tuple[float, float, float]:
        """Return what was commanded last: m/s ahead and to the left, deg/s."""
        raise NotImplementedError
