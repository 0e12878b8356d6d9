"""Messages of ROS to objects and back: yarpy beside rospy's generated classes and rosbags.

One thread, no network; the three take turns, so that a busy machine is as unkind to each, and the
best of the rounds counts. rospy is taken from the system (apt-get install python3-sensor-msgs
python3-nav-msgs python3-tf2-msgs); what is not installed is left out.

    python bench/ros_message.py [--rounds 200]
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from collections.abc import Callable
from io import BytesIO
from typing import Any

import numpy as np

from yarpy.peers.ros.message.catalogue import standard_sources
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Texts

DEBIAN = "/usr/lib/python3/dist-packages"
# What only an installed ROS brings.
EXTRA = Texts(
    {"tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms"}, "this benchmark"
)
SLICE = 0.0002  # seconds of calls in a row


def messages(library: Library) -> list[Any]:
    """A small one, joints, a scan, a tree of frames, and a picture of 1920 times 1080 pixels."""
    joints = library.message("sensor_msgs/JointState")
    scan = library.message("sensor_msgs/LaserScan")
    frames = library.message("tf2_msgs/TFMessage")
    frame = library.message("geometry_msgs/TransformStamped")
    image = library.message("sensor_msgs/Image")
    seven = np.arange(7.0)
    return [
        library.message("std_msgs/String")("hello"),
        joints(None, [f"joint_{n}" for n in range(7)], seven, seven, seven),
        scan(ranges=np.ones(1000, "f4"), intensities=np.ones(1000, "f4")),
        frames([frame() for _ in range(10)]),
        image(None, 1080, 1920, "rgb8", 0, 5760, np.zeros(1080 * 5760, "u1")),
    ]


def contenders(message: Any) -> dict[str, tuple[Callable[[], Any], Callable[[], Any]]]:
    """How each reads and writes this message."""
    data = b"".join(message.to_ros())
    found = {"yarpy": (lambda: type(message).from_ros(data), message.to_ros)}
    package, _, name = message._type.partition("/")
    try:
        kind = getattr(importlib.import_module(f"{package}.msg"), name)
    except ImportError:
        pass
    else:
        theirs = kind().deserialize(data)
        found["rospy"] = (lambda: kind().deserialize(data), lambda: theirs.serialize(BytesIO()))
    try:
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        return found
    store, full = get_typestore(Stores.ROS1_NOETIC), f"{package}/msg/{name}"
    if full in store.fielddefs:
        value = store.deserialize_ros1(data, full)
        found["rosbags"] = (
            lambda: store.deserialize_ros1(data, full),
            lambda: store.serialize_ros1(value, full),
        )
    return found


def best(calls: list[Callable[[], Any]], rounds: int) -> list[float]:
    """Microseconds of each, in turns."""
    counts = [max(1, int(SLICE / took(call, 1))) for call in calls]
    least = [float("inf")] * len(calls)
    for _ in range(rounds):
        for index, (call, count) in enumerate(zip(calls, counts, strict=True)):
            least[index] = min(least[index], took(call, count) / count * 1e6)
    return least


def took(call: Callable[[], Any], count: int) -> float:
    """Seconds of so many calls."""
    begin = time.perf_counter()
    for _ in range(count):
        call()
    return time.perf_counter() - begin


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=200)
    rounds = parser.parse_args().rounds
    sys.path.append(DEBIAN)
    print("| message | | read | write |")
    print("|---|---|---|---|")
    for message in messages(Library([*standard_sources(), EXTRA])):
        found = contenders(message)
        times = best([call for pair in found.values() for call in pair], rounds)
        for index, name in enumerate(found):
            read, write = times[2 * index : 2 * index + 2]
            print(f"| {message._type} | {name} | {read:.2f} | {write:.2f} |")


if __name__ == "__main__":
    main()
