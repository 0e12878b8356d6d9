"""The interface functions, written by `yarpy idl thrift`."""

from yarpy.kits import thrift

vocab = thrift.vocab


class Status(thrift.Struct):
    """The outcome of a call: ok, or err1 (failed) ... err7, miss."""

    code: vocab = ""


class BatteryData(thrift.Struct):
    """Percent, V, A, degrees Celsius; the status has the numbers of `yarpy.devices.BATTERY`."""

    charge: float = 0.0
    voltage: float = 0.0
    current: float = 0.0
    temperature: float = 0.0
    status: thrift.i32 = 3


class Info(thrift.Struct):
    status: thrift.Nested[Status] = thrift.new(lambda: Status())
    text: str = ""


class IBatteryMsgs(thrift.Service):
    @thrift.method
    def getBatteryInfoRPC(self) -> Info:
        raise NotImplementedError


connect = IBatteryMsgs.connect
connect_async = IBatteryMsgs.connect_async
