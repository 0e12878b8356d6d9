"""The topics of transforms, /tf and /tf_static: who hears them, and who says where frames lie.

    transforms = yarpy.ros.Transforms(node)
    found = transforms.lookup("map", "camera", timeout=5.0)     # found.pose, found.time
    found = transforms.lookup_full("base", 0, "camera", then, "map")
    transforms.send("map", "camera", (1.0, 0.0, 0.5))           # now, a frame that moves
    transforms.send("base", "laser", (0.1, 0.0, 0.2), fixed=True)

Rules: of a node of ROS 1, or of ROS 2 (`yarpy.ros2.Node`). What is sent is known here at once, and
published. A transform that makes no sense is left out, and the log says so, once for each kind of
mistake. Fixed frames are latched all together, as tf2 does.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, Protocol

from yarpy.log import logger, readable
from yarpy.peers.ros.transform.buffer import KEPT, Buffer, Found
from yarpy.peers.ros.transform.pose import Pose, Quaternion

log = logger("yarpy.ros")

TYPE: Final = "tf2_msgs/TFMessage"
MOVING: Final = "/tf"
FIXED: Final = "/tf_static"
_BACK: Final = 1.0  # seconds that a clock may be put back
_MOST_TOLD: Final = 20  # mistakes that the log names


class Writes(Protocol):
    """A publisher."""

    def write(self, value: object) -> object:
        """Send a value."""


def transform_of(
    parent: str, child: str, at: Sequence[float], turned: Sequence[float], stamp: object
) -> dict[str, Any]:
    """Return the fields of a TransformStamped: `at` in meters, `turned` a quaternion x, y, z, w."""
    return {
        "header": {"stamp": stamp, "frame_id": parent},
        "child_frame_id": child,
        "transform": {
            "translation": dict(zip("xyz", at, strict=True)),
            "rotation": dict(zip("xyzw", turned, strict=True)),
        },
    }


class Tree:
    """The part that both kinds of nodes share. `clock()` is the node's time, in seconds; `publish`
    makes a publisher of a topic, latched or not."""

    def __init__(
        self,
        clock: Callable[[], float],
        publish: Callable[[str, bool], Writes],
        kept: float = KEPT,
    ) -> None:
        self.buffer = Buffer(kept)
        self._clock = clock
        self._publish = publish
        self._writers: dict[bool, Writes] = {}
        self._fixed: dict[str, dict[str, Any]] = {}
        self._told: set[str] = set()
        self._seen = 0.0  # when the last message came
        self._lock = threading.Lock()  # transforms are sent by any thread

    def lookup(
        self, target: str, source: str, time: float = 0.0, timeout: float | None = 0.0
    ) -> Found:
        """Return where the frame `source` lies in `target`; see `Buffer.lookup`."""
        return self.buffer.lookup(target, source, time, timeout)

    def lookup_full(
        self,
        target: str,
        target_time: float,
        source: str,
        source_time: float,
        fixed: str,
        timeout: float | None = 0.0,
    ) -> Found:
        """Return where `source` lay then in `target` of another time; see `Buffer.lookup_full`."""
        return self.buffer.lookup_full(target, target_time, source, source_time, fixed, timeout)

    def can_transform(self, target: str, source: str, time: float = 0.0) -> bool:
        """Return whether `lookup` would succeed now."""
        return self.buffer.can_transform(target, source, time)

    def send(
        self,
        parent: str,
        child: str,
        at: Sequence[float] = (0.0, 0.0, 0.0),
        turned: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        *,
        time: float | None = None,
        fixed: bool = False,
    ) -> None:
        """Say where a frame lies in its parent: its origin in meters, and its orientation as a
        quaternion (x, y, z, w). `time` in seconds, None: now. Raises ValueError for what makes no
        sense."""
        x, y, z = map(float, at)
        quaternion: Quaternion = tuple(map(float, turned))  # type: ignore[assignment]
        if len(quaternion) != 4:
            raise ValueError("an orientation is a quaternion: x, y, z, w")
        when = self._clock() if time is None else time
        self.buffer.put(parent, child, Pose((x, y, z), quaternion), when, fixed)
        seconds, rest = divmod(round(when * 1e9), 1_000_000_000)
        made = transform_of(parent, child, (x, y, z), quaternion, self.stamp(seconds, rest))
        with self._lock:
            if fixed not in self._writers:
                self._writers[fixed] = self._publish(FIXED if fixed else MOVING, fixed)
            if fixed:
                self._fixed[child] = made
            self._writers[fixed].write({"transforms": [*self._fixed.values()] if fixed else [made]})

    def stamp(self, seconds: int, nanoseconds: int) -> object:
        """Return a time as the fields of a header's stamp."""
        raise NotImplementedError

    def time_of(self, stamp: Any) -> float:
        """Return the seconds of a header's stamp."""
        raise NotImplementedError

    def hear(self, message: Any, fixed: bool) -> None:
        """A message of either topic has come."""
        now = self._clock()
        if now < self._seen - _BACK:  # a simulation, or a recording, has begun anew
            self.buffer.clear()
        self._seen = now
        for item in message.transforms:
            at, turned = item.transform.translation, item.transform.rotation
            pose = Pose((at.x, at.y, at.z), (turned.x, turned.y, turned.z, turned.w))
            when = self.time_of(item.header.stamp)
            try:
                self.buffer.put(item.header.frame_id, item.child_frame_id, pose, when, fixed)
            except ValueError as error:
                self._complain(readable(str(error)))

    def _complain(self, text: str) -> None:
        with self._lock:
            if text in self._told or len(self._told) >= _MOST_TOLD:
                return
            self._told.add(text)
        log.warning("a transform is left out: %s", text)


class Transforms(Tree):
    """The transforms of the graph that a node of ROS 1 belongs to; the topics close with it."""

    def __init__(self, node: Any, kept: float = KEPT) -> None:
        super().__init__(
            node.now,
            lambda topic, latch: node.publisher(topic, TYPE, latch=latch, queue_size=100),
            kept,
        )
        for topic in (FIXED, MOVING):
            fixed = topic == FIXED
            node.subscriber(topic, TYPE, partial(self.hear, fixed=fixed))

    def stamp(self, seconds: int, nanoseconds: int) -> object:
        return [seconds, nanoseconds]

    def time_of(self, stamp: Any) -> float:
        return float(stamp.to_sec())
