"""The store of frames and where they are: what the ports `thrift` of frameTransformSet_nws_yarp and
frameTransformGet_nws_yarp are asked.
"""

from yarpy.kits.devices.declared import Answer, Status, function
from yarpy.kits.thrift.kind import Nested, i8
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Struct, new


class Transform(Struct):
    """The pose of the frame `target`, seen from `source`: metres, and a quaternion."""

    source: str = ""
    target: str = ""
    time: float = 0.0
    constant: i8 = 0
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    qw: float = 1.0


class Transforms(Answer):
    transforms: list[Transform] = new(list)


class FrameTransformStorageSetRPC(Service):
    setTransformsRPC = function(Status, transforms=list[Transform])
    setTransformRPC = function(Status, transform=Nested[Transform])
    deleteTransformRPC = function(Status, source=str, target=str)
    clearAllRPC = function(Status)


class FrameTransformStorageGetRPC(Service):
    getTransformsRPC = function(Transforms)
