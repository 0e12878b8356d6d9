"""Carriers of ROS driven by bytes alone, in either role."""

from typing import Any

from yarpy.carriers.base import Carrier
from yarpy.link.begin.handshake import recognise
from yarpy.peers.ros.header import LENGTH, encode_header, parse_header
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Texts
from yarpy.route import Declared, Route
from yarpy.testing import End
from yarpy.wire.steps import Steps

STRING = "992ce8a1687cec8c8bd883ec73ca41d1"
ADD = "6a2e34150c00229791cc89ff309fff21"


class _Services(Texts):
    def find(self, name: str, kind: str) -> str | None:
        return self.texts.get(name)


LIBRARY = Library(
    [
        _Services(
            {
                "std_msgs/String": "string data\n",
                "std_msgs/Int32": "int32 data\n",
                "std_msgs/UInt8MultiArray": "uint8[] data\n",
                "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id\n",
                "test/Stamped": "Header header\nuint8[] data\n",
                "rospy_tutorials/AddTwoInts": "int64 a\nint64 b\n---\nint64 sum\n",
            },
            "the tests",
        )
    ]
)
String = LIBRARY.message("std_msgs/String")
Int32 = LIBRARY.message("std_msgs/Int32")
Stamped = LIBRARY.message("test/Stamped")
AddTwoInts = LIBRARY.service("rospy_tutorials/AddTwoInts")


def welcomed(end: End, carriers: list[Carrier], route: Route) -> Steps[Carrier]:
    """What a port does with whoever dials; the carrier is put into `carriers`."""
    first = bytes((yield from end.stream.read_exact(8)))
    kind = recognise(first)
    assert kind is not None, first
    carrier = kind(Route("", route.target, kind.name, declared=route.declared))
    while (other := (yield from carrier.welcome(end.stream, first))) is not None:
        carrier = other
    carriers.append(carrier)
    return carrier


def accept(data: bytes, declared: Declared, piece: int = 0) -> tuple[End, Any]:
    """An end that was dialled with `data`, and its carrier."""
    end, carriers = End(piece), []  # type: ignore[var-annotated]
    end.begin(welcomed(end, carriers, Route("", "/port", declared=declared)))
    end.feed(data)
    assert end.done
    return end, carriers[0]


def header(**fields: str) -> bytes:
    return encode_header(fields)


def taken_header(end: End) -> tuple[dict[str, str], bytes]:
    """The header that an end has written, and what it wrote behind it."""
    data = end.take()
    (size,) = LENGTH.unpack_from(data)
    return parse_header(data[4 : 4 + size]), data[4 + size :]
