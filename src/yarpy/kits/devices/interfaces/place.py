"""The values of navigation: places, paths, areas and objects of a map, odometry, velocities.

Rules: metres and degrees, m/s and deg/s. A place is in the map `map_id`. These are the structs that
C++ calls Map2DLocation, Map2DPath, Map2DArea, Map2DObject, OdometryData, MobileBaseVelocity.
"""

from __future__ import annotations

from typing import Annotated

import yarpy
from yarpy.kits.thrift.kind import External
from yarpy.kits.thrift.structure import Struct, new

Point = Annotated[yarpy.Vector, External("yarp::math::Vec2D<double>", python="yarpy.Vector")]


class Place(Struct):
    """A place in a map, and where one looks there."""

    map_id: str = ""
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    description: str = ""


class Path(Struct):
    """Places, one after the other."""

    waypoints: list[Place] = new(list)
    description: str = ""


class Area(Struct):
    """A polygon in a map; each point is a Vector of x and y."""

    map_id: str = ""
    points: list[Point] = new(list)
    description: str = ""


class Thing(Struct):
    """An object in a map; the angles are roll, pitch and yaw."""

    map_id: str = ""
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0
    description: str = ""


class Odometry(Struct):
    """The pose that a base has by its odometry since it began, and its velocity: seen from the
    base, and from where it began."""

    odom_x: float = 0.0
    odom_y: float = 0.0
    odom_theta: float = 0.0
    base_vel_x: float = 0.0
    base_vel_y: float = 0.0
    base_vel_theta: float = 0.0
    odom_vel_x: float = 0.0
    odom_vel_y: float = 0.0
    odom_vel_theta: float = 0.0


class Velocity(Struct):
    """Of a base: ahead, to the left, turning to the left."""

    vel_x: float = 0.0
    vel_y: float = 0.0
    vel_theta: float = 0.0
