"""The battery of YARP 3.12 and later: what `/robot/battery/rpc:i` is asked, and what
`/robot/battery/data:o` sends.
"""

from yarpy.kits.devices.declared import Answer, function
from yarpy.kits.thrift.kind import i32
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Struct


class BatteryData(Struct):
    """Percent, V, A, degrees Celsius; the status has the numbers of `yarpy.devices.BATTERY`."""

    charge: float = 0.0
    voltage: float = 0.0
    current: float = 0.0
    temperature: float = 0.0
    status: i32 = 3


class Info(Answer):
    text: str = ""


class IBatteryMsgs(Service):
    getBatteryInfoRPC = function(Info)
