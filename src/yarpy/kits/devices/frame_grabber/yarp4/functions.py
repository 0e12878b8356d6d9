"""The interface functions, written by `yarpy idl thrift`."""

from typing import Annotated

import yarpy
from yarpy.kits import thrift

vocab = thrift.vocab


class Status(thrift.Struct):
    """The outcome of a call: ok, or err1 (failed) ... err7, miss."""

    code: vocab = ""


class Corner(thrift.Struct):
    """A corner of a part of an image."""

    x: thrift.i32 = 0
    y: thrift.i32 = 0


class Configuration(thrift.Struct):
    """A way to take images; the code is that of the pixels, a vocab that travels as a number."""

    width: thrift.i32 = 0
    height: thrift.i32 = 0
    rate: float = 0.0
    code: thrift.i32 = 0


Image = Annotated[object, thrift.External("yarp::sig::FlexImage")]
Property = Annotated[yarpy.Property, thrift.External("yarp::os::Property", 1, "yarpy.Property")]


class Picture(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    image: Image = thrift.new(yarpy.Bottle)


class Number(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: float = 0.0


class Pair(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    first: float = 0.0
    second: float = 0.0


class Size(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    width: thrift.i32 = 0
    height: thrift.i32 = 0


class Count(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: thrift.i32 = 0


class Truth(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    value: bool = False


class Configurations(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    configurations: list[Configuration] = thrift.new(list)


class Parameters(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    parameters: Property = thrift.new(yarpy.Property)


class Description(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    bus: thrift.i32 = 0
    text: str = ""


class Window(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    width: thrift.i32 = 0
    height: thrift.i32 = 0
    x: thrift.i32 = 0
    y: thrift.i32 = 0


class LargestWindow(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    width: thrift.i32 = 0
    height: thrift.i32 = 0
    x_step: thrift.i32 = 0
    y_step: thrift.i32 = 0
    x_offset_step: thrift.i32 = 0
    y_offset_step: thrift.i32 = 0


class FrameGrabberMsgs(thrift.Service):
    @thrift.method
    def getHeightRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getWidthRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getImageRPC(self) -> Picture:
        raise NotImplementedError

    @thrift.method
    def getImageCropRPC(self, kind: thrift.i32, corners: list[Corner]) -> Picture:
        raise NotImplementedError

    @thrift.method
    def getRgbWidthRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getRgbHeightRPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getRgbSupportedConfigurationsRPC(self) -> Configurations:
        raise NotImplementedError

    @thrift.method
    def getRgbResolutionRPC(self) -> Size:
        raise NotImplementedError

    @thrift.method
    def setRgbResolutionRPC(self, width: thrift.i32, height: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getRgbFOVRPC(self) -> Pair:
        raise NotImplementedError

    @thrift.method
    def setRgbFOVRPC(self, horizontal: float, vertical: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getRgbIntrinsicParamRPC(self) -> Parameters:
        raise NotImplementedError

    @thrift.method
    def getRgbMirroringRPC(self) -> Truth:
        raise NotImplementedError

    @thrift.method
    def setRgbMirroringRPC(self, mirror: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def getCameraDescriptionRPC(self) -> Description:
        raise NotImplementedError

    @thrift.method
    def hasFeatureRPC(self, feature: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def setFeature1RPC(self, feature: thrift.i32, value: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getFeature1RPC(self, feature: thrift.i32) -> Number:
        raise NotImplementedError

    @thrift.method
    def setFeature2RPC(self, feature: thrift.i32, first: float, second: float) -> Status:
        raise NotImplementedError

    @thrift.method
    def getFeature2RPC(self, feature: thrift.i32) -> Pair:
        raise NotImplementedError

    @thrift.method
    def hasOnOffRPC(self, feature: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def setActiveRPC(self, feature: thrift.i32, on: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def getActiveRPC(self, feature: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def hasAutoRPC(self, feature: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def hasManualRPC(self, feature: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def hasOnePushRPC(self, feature: thrift.i32) -> Truth:
        raise NotImplementedError

    @thrift.method
    def setModeRPC(self, feature: thrift.i32, mode: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getModeRPC(self, feature: thrift.i32) -> Count:
        raise NotImplementedError

    @thrift.method
    def setOnePushRPC(self, feature: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getVideoModeMaskDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getVideoModeDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def setVideoModeDC1394RPC(self, value: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getFPSMaskDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def getFPSDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def setFPSDC1394RPC(self, value: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getISOSpeedDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def setISOSpeedDC1394RPC(self, value: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getColorCodingMaskDC1394RPC(self, video_mode: thrift.i32) -> Count:
        raise NotImplementedError

    @thrift.method
    def getColorCodingDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def setColorCodingDC1394RPC(self, value: thrift.i32) -> Status:
        raise NotImplementedError

    @thrift.method
    def getFormat7MaxWindowDC1394RPC(self) -> LargestWindow:
        raise NotImplementedError

    @thrift.method
    def getFormat7WindowDC1394RPC(self) -> Window:
        raise NotImplementedError

    @thrift.method
    def setFormat7WindowDC1394RPC(
        self,
        width: thrift.i32,
        height: thrift.i32,
        x: thrift.i32,
        y: thrift.i32,
    ) -> Status:
        raise NotImplementedError

    @thrift.method
    def setOperationModeDC1394RPC(self, value: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def getOperationModeDC1394RPC(self) -> Truth:
        raise NotImplementedError

    @thrift.method
    def setTransmissionDC1394RPC(self, on: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def getTransmissionDC1394RPC(self) -> Truth:
        raise NotImplementedError

    @thrift.method
    def setBroadcastDC1394RPC(self, on: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def setDefaultsDC1394RPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def setResetDC1394RPC(self) -> Status:
        raise NotImplementedError

    @thrift.method
    def setPowerDC1394RPC(self, on: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def setCaptureDC1394RPC(self, on: bool) -> Status:
        raise NotImplementedError

    @thrift.method
    def getBytesPerPacketDC1394RPC(self) -> Count:
        raise NotImplementedError

    @thrift.method
    def setBytesPerPacketDC1394RPC(self, value: thrift.i32) -> Status:
        raise NotImplementedError


connect = FrameGrabberMsgs.connect
connect_async = FrameGrabberMsgs.connect_async
