"""Messages of ROS 1 in recordings, for `yarpy play`: the encoding `ros1` of MCAP, and of bags.

Rules: definitions and bytes are those of a file that anybody may have written: what is wrong in
them is a DecodeError, and what they may ask for is limited as for what comes over the network.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from yarpy.peers.ros.body import envelope_of
from yarpy.peers.ros.message.convert.native import to_native
from yarpy.peers.ros.message.library import default_library
from yarpy.peers.ros.message.parse import peer_type_name

#: the object of the type, what it is for programs of YARP, and its envelope
Read: TypeAlias = Callable[[bytes], tuple[Any, Any, str]]


def reader(name: str, language: str, text: str) -> Read:
    """Return what reads messages of a type.

    name: package/Type. language: of `text`, its definition with those of the types in it; where
    there is none, or in no language that is known here, it is looked for by the name. Raises
    UnknownType, DecodeError.
    """
    known = peer_type_name(name)
    library = default_library()
    spoken = language == "ros1msg" and bool(text.strip())
    kind = library.message_of(known, text) if spoken else library.message(known)
    headed = kind._has_header

    def read(data: bytes) -> tuple[Any, Any, str]:
        found = kind.from_ros(data)
        return found, to_native(found), envelope_of(data) if headed else ""

    return read
