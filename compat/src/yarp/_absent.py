"""Classes of C++ that a program of Python has no use for; see `_refusal`."""

from __future__ import annotations

from yarp._refusal import Absent
from yarp._table import NOT_HERE


class NameStore(Absent, members="announce process query", why=NOT_HERE["NameStore"]):
    """Answers for names in C++."""


class Wire(Absent, members="yarp", why=NOT_HERE["Wire"]):
    """The base of what the compiler of C++ makes of Thrift files."""


class WireLink(
    Absent,
    members="attachAsClient attachAsServer callback canRead canWrite isValid setOwner "
    "setStreamingMode write",
    why=NOT_HERE["WireLink"],
):
    """The connection of a Wire."""


class DriverCreator(
    Absent,
    members="create getCode getName getWrapper owner toString_c",
    why=NOT_HERE["DriverCreator"],
):
    """Makes devices of a type in C++."""


class StubDriverCreator(
    Absent,
    members="create getCode getName getWrapper toString_c",
    why=NOT_HERE["StubDriverCreator"],
):
    """Finds devices in shared libraries."""


class LogStream(Absent, why=NOT_HERE["LogStream"]):
    """Collects what << is given in C++."""


class IControlDebug(
    Absent,
    members="loadBootMemory saveBootMemory setPrintFunction",
    why=NOT_HERE["IControlDebug"],
):
    """The memory of a motor's board, from which it starts."""


class IFrameGrabberControlsDC1394(
    Absent,
    members="getBytesPerPacketDC1394 getColorCodingDC1394 getColorCodingMaskDC1394 getFPSDC1394 "
    "getFPSMaskDC1394 getFormat7MaxWindowDC1394 getFormat7WindowDC1394 getISOSpeedDC1394 "
    "getOperationModeDC1394 getTransmissionDC1394 getVideoModeDC1394 getVideoModeMaskDC1394 "
    "setBroadcastDC1394 setBytesPerPacketDC1394 setCaptureDC1394 setColorCodingDC1394 "
    "setDefaultsDC1394 setFPSDC1394 setFormat7WindowDC1394 setISOSpeedDC1394 "
    "setOperationModeDC1394 setPowerDC1394 setResetDC1394 setTransmissionDC1394 "
    "setVideoModeDC1394",
    why=NOT_HERE["IFrameGrabberControlsDC1394"],
):
    """Registers of cameras at FireWire."""
