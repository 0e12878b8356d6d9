"""SerialPort: bytes to a device and from it, as words in a Bottle.

Source: ISerialDevice of YARP 3.8 to 4.0. `receive` sends what has come since, every period.
"""

from __future__ import annotations

from yarpy.data.bottle import Bottle
from yarpy.kits.devices.network.model import Interface, call, published, taken
from yarpy.kits.thrift.kind import i32


class SerialPort(Interface):
    """A serial port."""

    NWS, NWC = "serialPort_nws_yarp", "serialPort_nwc_yarp"
    FAKE = "fakeSerialPort"
    VIEW = "ISerialDevice"

    @taken("in", Bottle, cpp="send")
    def send(self, message: Bottle) -> None:
        """Send the first word of a Bottle."""

    @published("out", cpp="receive")
    def receive(self) -> Bottle:
        """Return what has come, in one word; nothing if nothing has."""
        raise NotImplementedError

    @call("setDTR", cpp="setDTR", status=False)
    def enable_ready_line(self, enable: bool) -> bool:
        """Set the line that says that a terminal is ready; True if that could be done."""
        raise NotImplementedError

    @call("flush", cpp="flush", status=False)
    def flush(self) -> i32:
        """Throw away what has come; return how many bytes those were."""
        raise NotImplementedError
