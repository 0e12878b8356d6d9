"""The camera of YARP 4: what `/robot/eye/rpc` is asked, and the port of the images.

Every answer begins with a Status. Features have the numbers of `yarpy.devices.FEATURES`; angles
are in degrees, sizes in pixels. Functions with DC1394 are about cameras at FireWire.
"""

from typing import Annotated

import yarpy
from yarpy.kits.devices.declared import Answer, Status, function
from yarpy.kits.thrift.kind import External, i32
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Struct, new


class Corner(Struct):
    """A corner of a part of an image."""

    x: i32 = 0
    y: i32 = 0


class Configuration(Struct):
    """A way to take images; the code is that of the pixels, a vocab that travels as a number."""

    width: i32 = 0
    height: i32 = 0
    rate: float = 0.0
    code: i32 = 0


Image = Annotated[object, External("yarp::sig::FlexImage")]
Property = Annotated[yarpy.Property, External("yarp::os::Property", 1, "yarpy.Property")]


class Picture(Answer):
    image: Image = new(yarpy.Bottle)


class Number(Answer):
    value: float = 0.0


class Pair(Answer):
    first: float = 0.0
    second: float = 0.0


class Size(Answer):
    width: i32 = 0
    height: i32 = 0


class Count(Answer):
    value: i32 = 0


class Truth(Answer):
    value: bool = False


class Configurations(Answer):
    configurations: list[Configuration] = new(list)


class Parameters(Answer):
    parameters: Property = new(yarpy.Property)


class Description(Answer):
    bus: i32 = 0
    text: str = ""


class Window(Answer):
    width: i32 = 0
    height: i32 = 0
    x: i32 = 0
    y: i32 = 0


class LargestWindow(Answer):
    width: i32 = 0
    height: i32 = 0
    x_step: i32 = 0
    y_step: i32 = 0
    x_offset_step: i32 = 0
    y_offset_step: i32 = 0


class FrameGrabberMsgs(Service):
    # images
    getHeightRPC = function(Count)
    getWidthRPC = function(Count)
    getImageRPC = function(Picture)
    getImageCropRPC = function(Picture, kind=i32, corners=list[Corner])

    # the lens
    getRgbWidthRPC = function(Count)
    getRgbHeightRPC = function(Count)
    getRgbSupportedConfigurationsRPC = function(Configurations)
    getRgbResolutionRPC = function(Size)
    setRgbResolutionRPC = function(Status, width=i32, height=i32)
    getRgbFOVRPC = function(Pair)
    setRgbFOVRPC = function(Status, horizontal=float, vertical=float)
    getRgbIntrinsicParamRPC = function(Parameters)
    getRgbMirroringRPC = function(Truth)
    setRgbMirroringRPC = function(Status, mirror=bool)

    # features
    getCameraDescriptionRPC = function(Description)
    hasFeatureRPC = function(Truth, feature=i32)
    setFeature1RPC = function(Status, feature=i32, value=float)
    getFeature1RPC = function(Number, feature=i32)
    setFeature2RPC = function(Status, feature=i32, first=float, second=float)
    getFeature2RPC = function(Pair, feature=i32)
    hasOnOffRPC = function(Truth, feature=i32)
    setActiveRPC = function(Status, feature=i32, on=bool)
    getActiveRPC = function(Truth, feature=i32)
    hasAutoRPC = function(Truth, feature=i32)
    hasManualRPC = function(Truth, feature=i32)
    hasOnePushRPC = function(Truth, feature=i32)
    setModeRPC = function(Status, feature=i32, mode=i32)
    getModeRPC = function(Count, feature=i32)
    setOnePushRPC = function(Status, feature=i32)

    # FireWire
    getVideoModeMaskDC1394RPC = function(Count)
    getVideoModeDC1394RPC = function(Count)
    setVideoModeDC1394RPC = function(Status, value=i32)
    getFPSMaskDC1394RPC = function(Count)
    getFPSDC1394RPC = function(Count)
    setFPSDC1394RPC = function(Status, value=i32)
    getISOSpeedDC1394RPC = function(Count)
    setISOSpeedDC1394RPC = function(Status, value=i32)
    getColorCodingMaskDC1394RPC = function(Count, video_mode=i32)
    getColorCodingDC1394RPC = function(Count)
    setColorCodingDC1394RPC = function(Status, value=i32)
    getFormat7MaxWindowDC1394RPC = function(LargestWindow)
    getFormat7WindowDC1394RPC = function(Window)
    setFormat7WindowDC1394RPC = function(Status, width=i32, height=i32, x=i32, y=i32)
    setOperationModeDC1394RPC = function(Status, value=bool)
    getOperationModeDC1394RPC = function(Truth)
    setTransmissionDC1394RPC = function(Status, on=bool)
    getTransmissionDC1394RPC = function(Truth)
    setBroadcastDC1394RPC = function(Status, on=bool)
    setDefaultsDC1394RPC = function(Status)
    setResetDC1394RPC = function(Status)
    setPowerDC1394RPC = function(Status, on=bool)
    setCaptureDC1394RPC = function(Status, on=bool)
    getBytesPerPacketDC1394RPC = function(Count)
    setBytesPerPacketDC1394RPC = function(Status, value=i32)
