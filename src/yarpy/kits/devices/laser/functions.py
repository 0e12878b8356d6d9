"""The laser scanner of YARP 3.10 and later: what `/robot/laser/rpc:i` is asked, and what
`/robot/laser` sends. Angles are in degrees, distances in metres.
"""

from typing import Annotated

import yarpy
from yarpy.kits.devices.declared import Answer, Status, function
from yarpy.kits.thrift.kind import External, i32, vocab
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Struct, new

Vector = Annotated[yarpy.Vector, External("yarp::sig::Vector", 1, "yarpy.Vector")]


class LaserScan2D(Struct):
    """The first of the ranges belongs to the first angle; what hit nothing is infinite."""

    angle_min: float = 0.0
    angle_max: float = 0.0
    range_min: float = 0.0
    range_max: float = 0.0
    scans: Vector = new(yarpy.Vector)
    status: i32 = 3


class Condition(Answer):
    condition: vocab = ""


class Limits(Answer):
    low: float = 0.0
    high: float = 0.0


class Number(Answer):
    value: float = 0.0


class Info(Answer):
    text: str = ""


class IRangefinder2DMsgs(Service):
    getDeviceStatus_RPC = function(Condition)
    getDistanceRange_RPC = function(Limits)
    getScanLimits_RPC = function(Limits)
    getHorizontalResolution_RPC = function(Number)
    getScanRate_RPC = function(Number)
    getDeviceInfo_RPC = function(Info)
    setDistanceRange_RPC = function(Status, low=float, high=float)
    setScanLimits_RPC = function(Status, low=float, high=float)
    setHorizontalResolution_RPC = function(Status, step=float)
    setScanRate_RPC = function(Status, rate=float)
