"""The frames that are known, and where each lies in its parent, now and some seconds ago.

Rules: pure but for a lock. Each frame has one parent at a time; a fixed frame lies there at any
time. Between two moments a pose is interpolated, beyond them it is an error, as in tf2. Names may
begin with a slash, as those of the first tf, which is left out. Numbers of frames and of moments
have limits: anybody may publish some.
"""

from __future__ import annotations

import math
import threading
import time
from bisect import bisect_right, insort
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from yarpy.errors import UnknownName
from yarpy.limit import ROS_FRAME_NAME, ROS_FRAMES, ROS_MOMENTS
from yarpy.peers.ros.transform.pose import Pose, between, unit

KEPT: Final = 10.0  # seconds, as in tf2
_DEPTH: Final = 1000  # frames above each other


class NoTransform(UnknownName):
    """There is no way between two frames, or none at that time."""


@dataclass(order=True, slots=True)
class _Moment:
    """`time` in nanoseconds."""

    time: int
    parent: str = field(compare=False)
    pose: Pose = field(compare=False)


@dataclass(frozen=True, slots=True)
class Found:
    """The pose of the frame `source` in `target` at `time`, in seconds; 0: always."""

    target: str
    source: str
    time: float
    pose: Pose


class Buffer:
    """Transforms of the last `kept` seconds."""

    def __init__(self, kept: float = KEPT) -> None:
        self._kept = round(kept * 1e9)
        self._moments: dict[str, list[_Moment]] = {}
        self._fixed: dict[str, _Moment] = {}
        self._changed = threading.Condition()

    def put(self, parent: str, child: str, pose: Pose, time: float, fixed: bool = False) -> None:
        """Take where a frame lies in its parent, at `time` in seconds. What is older than all that
        is kept is left out. Raises ValueError for names or numbers that are none."""
        parent, child = frame(parent), frame(child)
        if parent == child:
            raise ValueError(f'the frame "{child}" cannot lie in itself')
        if not all(map(math.isfinite, (*pose.at, time))):
            raise ValueError(f'the place of the frame "{child}" is no number')
        moment = _Moment(round(time * 1e9), parent, Pose(pose.at, unit(pose.turned)))
        with self._changed:
            if len(self._moments) + len(self._fixed) >= ROS_FRAMES and not self._knows(child):
                raise ValueError(f"more than {ROS_FRAMES} frames")
            if fixed:
                self._fixed[child] = moment
                self._moments.pop(child, None)
            else:
                self._fixed.pop(child, None)
                self._add(self._moments.setdefault(child, []), moment)
            self._changed.notify_all()

    def clear(self) -> None:
        """Forget all but fixed frames, as when time begins anew."""
        with self._changed:
            self._moments.clear()

    def _add(self, moments: list[_Moment], moment: _Moment) -> None:
        if moments and moment.time < moments[-1].time - self._kept:
            return
        at = bisect_right(moments, moment)
        if at and moments[at - 1].time == moment.time:
            moments[at - 1] = moment  # said once more
        else:
            insort(moments, moment)
        oldest = moments[-1].time - self._kept
        while moments[0].time < oldest or len(moments) > ROS_MOMENTS:
            del moments[0]

    def _knows(self, child: str) -> bool:
        return child in self._moments or child in self._fixed

    @property
    def frames(self) -> list[str]:
        """The names of all frames that are known."""
        with self._changed:
            parents = {item.parent for item in self._fixed.values()}
            parents |= {moments[-1].parent for moments in self._moments.values()}
            return sorted(parents | {*self._moments, *self._fixed})

    def lookup(
        self, target: str, source: str, time: float = 0.0, timeout: float | None = 0.0
    ) -> Found:
        """Return where `source` lies in `target` at `time`, in seconds; 0: the latest time at which
        all is known. It maps coordinates in `source` to those in `target`.

        Waits `timeout` seconds for what is not known yet, None: for ever. Raises NoTransform (a
        LookupError), which says what is missing.
        """
        target, source = frame(target), frame(source)
        return self._wait(lambda: self._lookup(target, source, round(time * 1e9)), timeout)

    def lookup_full(
        self,
        target: str,
        target_time: float,
        source: str,
        source_time: float,
        fixed: str,
        timeout: float | None = 0.0,
    ) -> Found:
        """Return where `source` lay at `source_time` in `target` as that lay at `target_time`, both
        in seconds, as seen from the frame `fixed`, which stays where it is meanwhile: where a robot
        of now has what its camera saw then. The time of what is found is that of `target`. As
        `lookup_transform_full` of tf2; else as `lookup`.
        """
        target, source, fixed = frame(target), frame(source), frame(fixed)

        def find() -> Found:
            then = self._lookup(fixed, source, round(source_time * 1e9))
            now = self._lookup(target, fixed, round(target_time * 1e9))
            return Found(target, source, now.time, now.pose @ then.pose)

        return self._wait(find, timeout)

    def _wait(self, find: Callable[[], Found], timeout: float | None) -> Found:
        """Return what `find` finds, once it does."""
        until = None if timeout is None else _now() + timeout
        with self._changed:
            while True:
                try:
                    return find()
                except NoTransform:
                    left = None if until is None else until - _now()
                    if left is not None and left <= 0:
                        raise
                    self._changed.wait(left)

    def can_transform(self, target: str, source: str, time: float = 0.0) -> bool:
        """Return whether `lookup` would succeed now."""
        try:
            self.lookup(target, source, time)
        except NoTransform:
            return False
        return True

    def _lookup(self, target: str, source: str, time: int) -> Found:
        for name in (target, source):
            if name not in self._moments and name not in self._fixed and not self._is_parent(name):
                raise NoTransform(f'there is no frame "{name}"')
        if not time:
            time = self._common(target, source)
        up, why = self._chain(source, time)
        down, why_not = self._chain(target, time)
        here = dict(down)
        for name, pose in up:
            if name in here:
                found = here[name].inverse() @ pose
                return Found(target, source, time / 1e9, found)
        apart = f'"{source}" and "{target}" are in trees that are not connected'
        raise NoTransform(why or why_not or apart)

    def _is_parent(self, name: str) -> bool:
        return any(item.parent == name for item in self._fixed.values()) or any(
            moments[-1].parent == name for moments in self._moments.values()
        )

    def _common(self, target: str, source: str) -> int:
        """The latest time that all moving frames on the way have; 0 where none moves. As in tf2 a
        frame is on the way to itself."""
        if target == source and target in self._moments and target not in self._fixed:
            return self._moments[target][-1].time
        chains = [self._latest(name) for name in (source, target)]
        shared = {name for name, _ in chains[0]} & {name for name, _ in chains[1]}
        times = []
        for chain in chains:
            for name, moment in chain:
                if name in shared:
                    break
                if moment is not None and name not in self._fixed:
                    times.append(moment.time)
        return min(times, default=0)

    def _latest(self, name: str) -> list[tuple[str, _Moment | None]]:
        """The frames from one up to its root, with the last moment of each."""
        found: list[tuple[str, _Moment | None]] = []
        while len(found) < _DEPTH:
            moments = self._moments.get(name)
            moment = self._fixed.get(name) or (moments[-1] if moments else None)
            found.append((name, moment))
            if moment is None:
                return found
            name = moment.parent
        raise NoTransform(f'the frame "{name}" lies in itself, or {_DEPTH} frames deep')

    def _chain(self, name: str, time: int) -> tuple[list[tuple[str, Pose]], str]:
        """The frames from one up to its root, and where the first lies in each; as far as that is
        known at that time, and why no further."""
        pose = Pose()
        found = [(name, pose)]
        while len(found) < _DEPTH:
            fixed = self._fixed.get(name)
            if fixed is not None:
                moment = fixed
            elif name in self._moments:
                try:
                    moment = _at(name, self._moments[name], time)
                except NoTransform as error:
                    return found, str(error)
            else:
                return found, ""
            name, pose = moment.parent, moment.pose @ pose
            found.append((name, pose))
        raise NoTransform(f'the frame "{name}" lies in itself, or {_DEPTH} frames deep')


def _at(name: str, moments: list[_Moment], time: int) -> _Moment:
    """Return the pose of a frame; interpolated between the moments around that time."""
    at = bisect_right(moments, _Moment(time, "", Pose()))
    if at and moments[at - 1].time == time:
        return moments[at - 1]
    if at == 0 or at == len(moments):
        first, last = moments[0].time / 1e9, moments[-1].time / 1e9
        way = "before" if at == 0 else "after"
        raise NoTransform(
            f'the frame "{name}" is known from {first:.3f} to {last:.3f} s, and {time / 1e9:.3f} s '
            f"is {way} that"
        )
    before, after = moments[at - 1], moments[at]
    if before.parent != after.parent:
        return before  # it has moved to another parent meanwhile
    share = (time - before.time) / (after.time - before.time)
    return _Moment(time, before.parent, between(before.pose, after.pose, share))


def frame(name: str) -> str:
    """Return the name of a frame without a slash in front. Raises ValueError for none."""
    plain = name.removeprefix("/")
    if not plain or len(plain) > ROS_FRAME_NAME:
        raise ValueError(f'"{name[:80]}" is no name of a frame')
    return plain


def _now() -> float:
    return time.monotonic()
