"""The interface functions, written by `yarpy idl thrift`."""

from typing import Annotated

import yarpy
from yarpy.kits import thrift

vocab = thrift.vocab


class Status(thrift.Struct):
    """The outcome of a call: ok, or err1 (failed) ... err7, miss."""

    code: vocab = ""


Vector = Annotated[yarpy.Vector, thrift.External("yarp::sig::Vector", 1, "yarpy.Vector")]


class LaserScan2D(thrift.Struct):
    """The first of the ranges belongs to the first angle; what hit nothing is infinite."""

    angle_min: float = 0.0
    angle_max: float = 0.0
    range_min: float = 0.0
    range_max: float = 0.0
    scans: Vector = thrift.new(yarpy.Vector)
    status: thrift.i32 = 3


class Condition(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    condition: vocab = ""


class Limits(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    low: float = 0.0
    high: float = 0.0


class Number(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: float = 0.0


class Info(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    text: str = ""


class IRangefinder2DMsgs(thrift.Service):
    @thrift.method
    def getDeviceStatus_RPC(self) -> Condition:
        raise NotImplementedError

    @thrift.method
    def getDistanceRange_RPC(self) -> Limits:
        raise NotImplementedError

    @thrift.method
    def getScanLimits_RPC(self) -> Limits:
        raise NotImplementedError

    @thrift.method
    def getHorizontalResolution_RPC(self) -> Number:
        raise NotImplementedError

    @thrift.method
    def getScanRate_RPC(self) -> Number:
        raise NotImplementedError

    @thrift.method
    def getDeviceInfo_RPC(self) -> Info:
        raise NotImplementedError

    @thrift.method
    def setDistanceRange_RPC(self, low: float, high: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setScanLimits_RPC(self, low: float, high: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setHorizontalResolution_RPC(self, step: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def setScanRate_RPC(self, rate: float) -> Status:
        raise NotImplementedError


connect = IRangefinder2DMsgs.connect
connect_async = IRangefinder2DMsgs.connect_async
