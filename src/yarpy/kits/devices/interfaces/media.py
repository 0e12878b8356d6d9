"""Sounds, images and tables that devices exchange, as annotations; and the sizes of buffers.

Source: yarp::sig of YARP 3.9 to 4.0.
"""

from __future__ import annotations

from typing import Annotated

import yarpy
from yarpy.data.value import Vocab
from yarpy.kits.thrift.kind import External, i32, size_t
from yarpy.kits.thrift.structure import Struct

SoundOf = Annotated[yarpy.Sound, External("yarp::sig::Sound", python="yarpy.Sound")]
Table = Annotated[yarpy.Property, External("yarp::os::Property", python="yarpy.Property")]
Transform = Annotated[yarpy.Matrix, External("yarp::sig::Matrix", python="yarpy.Matrix")]


class Text(Struct):
    """A text; several words are one."""

    text: str = ""

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Text:
        """Read any Bottle of words. DecodeError."""
        return cls(" ".join(str(each) for each in yarpy.Bottle.from_bytes(view)))


class AudioSize(Struct):
    """The size of a buffer. `depth`: bytes of a sample; `size`: samples of all channels."""

    samples: i32 = 0
    channels: i32 = 0
    depth: i32 = 0
    size: i32 = 0


class AudioStatus(Struct):
    """The state of a recorder or player: is it at work, and how many samples are in its buffer, at
    present and at most."""

    enabled: bool = False
    current: size_t = 0
    most: size_t = 0


class When(Struct):
    """The count and the time of a measurement."""

    count: i32 = 0
    time: float = 0.0


class Configuration(Struct):
    """A way to take images: pixels, images a second, and the number of the vocab of the pixels."""

    width: i32 = 0
    height: i32 = 0
    rate: float = 0.0
    code: i32 = Vocab("rgb").code
