"""The interface functions, written by `yarpy idl thrift`."""

from yarpy.kits import thrift

vocab = thrift.vocab


class Status(thrift.Struct):
    """The outcome of a call: ok, or err1 (failed) ... err7, miss."""

    code: vocab = ""


class Transform(thrift.Struct):
    """Where the frame `target` is, seen from `source`: metres, and a quaternion."""

    source: str = ""
    target: str = ""
    time: float = 0.0
    constant: thrift.i8 = 0
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    qw: float = 1.0


class Transforms(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    transforms: list[Transform] = thrift.new(list)


class FrameTransformStorageSetRPC(thrift.Service):
    @thrift.method
    def setTransformsRPC(self, transforms: list[Transform]) -> Status:
        raise NotImplementedError

    @thrift.method
    def setTransformRPC(self, transform: thrift.Nested[Transform]) -> Status:
        raise NotImplementedError

    @thrift.method
    def deleteTransformRPC(self, source: str, target: str) -> Status:
        raise NotImplementedError

    @thrift.method
    def clearAllRPC(self) -> Status:
        raise NotImplementedError


class FrameTransformStorageGetRPC(thrift.Service):
    @thrift.method
    def getTransformsRPC(self) -> Transforms:
        raise NotImplementedError
