"""Messages to the bytes of ROS 2; that they are right is tested with the reader."""

import numpy as np
import pytest

from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros2.message.library import Library
from yarpy.peers.ros2.message.source import Standard

LIBRARY = Library([Standard()])


def written(cls: type, **fields: object) -> bytes:
    return b"".join(cls(**fields).to_ros())


def test_golden_bytes() -> None:
    assert written(LIBRARY.message("std_msgs/String"), data="hi") == bytes.fromhex(
        "00010000 03000000 686900"
    )
    assert written(LIBRARY.message("std_msgs/Empty")) == bytes.fromhex("00010000 00")


def test_seconds_are_a_time_wherever_one_is_wanted() -> None:
    text = "builtin_interfaces/Time at\nbuiltin_interfaces/Duration[] spans\n"
    cls = Library([Texts({"p/T": text}, "here"), Standard()]).message("p/T")
    parts = {"at": (12, 500_000_000), "spans": [(-1, 750_000_000), (2, 0)]}
    wanted = cls.from_bottle(parts)
    seconds = {"at": 12.5, "spans": [-0.25, 2]}
    made = cls(**seconds)
    assert cls.from_ros(b"".join(made.to_ros())) == wanted
    assert cls.from_wire(b"".join(made.to_wire())) == wanted
    assert made.to_bottle() == wanted.to_bottle()
    assert cls.from_bottle(seconds) == wanted
    time = LIBRARY.message("builtin_interfaces/Time")
    assert time.from_bottle(12.5) == time(12, 500_000_000)
    for wrong in ("12", float("inf"), True):
        with pytest.raises(TypeError, match=r"p/T\.at: expected \S+/Time or seconds"):
            written(cls, at=wrong)
    with pytest.raises(OverflowError, match=r"p/T\.at\.sec: 3000000000 does not fit in int32"):
        written(cls, at=3e9)


def test_large_arrays_are_blocks_of_their_own() -> None:
    pixels = np.arange(9000, dtype="u1")
    blocks = LIBRARY.message("sensor_msgs/Image")(data=pixels).to_ros()
    assert len(blocks) == 2
    assert np.shares_memory(np.frombuffer(blocks[1], "u1"), pixels)
    strided = LIBRARY.message("sensor_msgs/Image")(data=pixels[::2])
    assert bytes(strided.to_ros()[1]) == pixels[::2].tobytes()


@pytest.mark.parametrize(
    ("text", "value", "says"),
    [
        ("uint8[<=2] a", [1, 2, 3], "at most 2 elements, here are 3"),
        ("uint8[2] a", [1], "2 elements are wanted"),
        ("uint8 a", 256, "p/T.a: 256 does not fit in uint8"),
        ("string a", 3, "p/T.a: expected a string, got 3"),
        ("string[] a", "abc", "p/T.a: expected a list"),
        ("float64[] a", ["x"], "p/T.a: expected float64 numbers"),
    ],
)
def test_what_does_not_fit_is_named(text: str, value: object, says: str) -> None:
    cls = Library([Texts({"p/T": text}, "here")]).message("p/T")
    with pytest.raises((TypeError, OverflowError, ValueError), match=says):
        written(cls, a=value)
