"""Messages of ROS 2 in recordings, for `yarpy play`: the encoding `cdr` of MCAP, and of bags.

Rules: as in `ros/bag/recorded.py`. What says no definition is of a type that is found by its name.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from yarpy.errors import DecodeError
from yarpy.limit import ROS_FULL_TEXT
from yarpy.peers.ros.message.convert.native import to_native
from yarpy.peers.ros2.body import Ros2Message
from yarpy.peers.ros2.message.action import plain_name
from yarpy.peers.ros2.message.library import Library, default_library

#: the object of the type, what it is for programs of YARP, and its envelope
Read: TypeAlias = Callable[[bytes], tuple[Any, Any, str]]


def reader(name: str, language: str, text: str) -> Read:
    """Return what reads messages of a type. Raises UnknownType, DecodeError.

    name: package/msg/Type. language: of `text`, its definition with those of the types in it.
    """
    plain = plain_name(name)
    if len(text) > ROS_FULL_TEXT:
        raise DecodeError(f"{plain}: a definition of more than {ROS_FULL_TEXT} characters")
    library = default_library()
    if language == "ros2msg" and text.strip():
        # A library of its own: what a file defines goes with its reader.
        kind = Library(library.sources).message_of(plain, text)
    else:
        kind = library.message(plain)
    headed = kind._has_header

    def read(data: bytes) -> tuple[Any, Any, str]:
        message = Ros2Message("", data, kind, headed, 0, 0)
        envelope = message.envelope if headed else ""
        return message.ros, to_native(message.ros), envelope

    return read
