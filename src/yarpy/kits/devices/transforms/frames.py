"""Frames and where they are, seen from each other: a tree of transforms.

    frames.place("camera", "head", (0.1, 0, 0))
    frames.place("head", "base", (0, 0, 1.2), (0, 0, 0.7071, 0.7071))
    frames.pose("camera", "base")        # a 4 x 4 matrix: where the camera is, seen from the base

Rules: positions in metres, rotations as quaternions x y z w of any length but 0. A frame has one
parent; a later transform replaces an earlier one. What is not constant is forgotten `expiry`
seconds after it was measured. No frame is, through others, its own parent.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Sequence
from math import hypot, isfinite
from typing import TYPE_CHECKING, Any, Final

from yarpy import clock
from yarpy.kits.devices.transforms.functions import Transform

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: Transforms that are kept at most, and in a row: anybody can set some.
MOST: Final = 5000
LONGEST: Final = 200


class Frames:
    """The frames. Any thread may use them. `now` is the clock, in seconds."""

    def __init__(self, expiry: float = 0.2, now: Callable[[], float] = clock.now) -> None:
        self.expiry = expiry
        self._now = now
        self._lock = threading.Lock()  # guards the dict
        self._known: dict[str, Transform] = {}  # by the frame that is placed

    def place(
        self,
        frame: str,
        parent: str,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        *,
        constant: bool = False,
    ) -> None:
        """`frame` is there, seen from `parent`. Raises ValueError."""
        self.add([transform(frame, parent, position, rotation, constant, self._now())])

    def add(self, transforms: Iterable[Transform]) -> None:
        """Take these, all or none. Raises ValueError."""
        fresh = [*transforms]
        for each in fresh:
            check(each)
        with self._lock:
            known = {**self._alive(), **{each.target: each for each in fresh}}
            if len(known) > MOST:
                raise ValueError(f"more than {MOST} frames")
            for each in fresh:
                _path(known, each.target)
            self._known = known

    def remove(self, frame: str, parent: str) -> bool:
        """Forget where it is; whether that was known. `*` stands for every frame or parent, and
        none of them is well too. The two are found in either order, as clients of C++ have both."""

        def goes(each: Transform) -> bool:
            there = frame in ("*", each.target) and parent in ("*", each.source)
            return there or (each.source, each.target) == (frame, parent)

        with self._lock:
            known = self._alive()
            self._known = {name: each for name, each in known.items() if not goes(each)}
            return len(self._known) < len(known) or "*" in (frame, parent)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._known = {}

    def all(self) -> list[Transform]:
        """Return all transforms that are known."""
        with self._lock:
            self._known = self._alive()
            return [*self._known.values()]

    def pose(self, frame: str, reference: str) -> NDArray[Any]:
        """Return the pose of `frame`, seen from `reference`: a 4 x 4 matrix. Raises LookupError."""
        return pose({each.target: each for each in self.all()}, frame, reference)

    def _alive(self) -> dict[str, Transform]:
        oldest = self._now() - self.expiry
        return {n: each for n, each in self._known.items() if each.constant or each.time > oldest}


def transform(
    frame: str,
    parent: str,
    position: Sequence[float],
    rotation: Sequence[float],
    constant: bool,
    when: float,
) -> Transform:
    """A transform of these. ValueError."""
    if len(position) != 3 or len(rotation) != 4:
        raise ValueError("a position has three numbers, a rotation four: x y z w")
    numbers = [*map(float, position), *map(float, rotation)]
    made = Transform(parent, frame, when, int(constant), *numbers)
    check(made)
    return made


def check(given: Transform) -> None:
    """ValueError if it is none."""
    numbers = (given.time, given.x, given.y, given.z, given.qx, given.qy, given.qz, given.qw)
    if not all(isfinite(number) for number in numbers):
        raise ValueError("the numbers of a transform are finite")
    if not 1e-9 < _length(given) < 1e100:
        raise ValueError("a rotation is a quaternion, x y z w, that is not 0")
    if not given.source or not given.target or given.source == given.target:
        raise ValueError("a frame and its parent need names, and not the same")


def pose(known: dict[str, Transform], frame: str, reference: str) -> NDArray[Any]:
    """Return the pose of `frame`, seen from `reference`: a 4 x 4 matrix. Raises LookupError if one
    of them is not among the known, or no path joins them."""
    import numpy as np

    there, here = _path(known, frame), _path(known, reference)
    names = {*known, *(each.source for each in known.values())}
    for name in (frame, reference):
        if name not in names:
            near = ", ".join(sorted(names)[:10])
            raise LookupError(f'there is no frame "{name}", there are {near or "none"}')
    if (there[-1].source if there else frame) != (here[-1].source if here else reference):
        raise LookupError(f'nothing connects "{frame}" with "{reference}"')
    found: NDArray[Any] = np.linalg.inv(_product(here)) @ _product(there)
    return found


def matrix(given: Transform) -> NDArray[Any]:
    """Return a transform as a 4 x 4 matrix."""
    import numpy as np

    length = _length(given)
    x, y, z, w = (number / length for number in (given.qx, given.qy, given.qz, given.qw))
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), given.x],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), given.y],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), given.z],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def _product(path: Sequence[Transform]) -> NDArray[Any]:
    """Return the pose of the first frame of a path, seen from its root."""
    import numpy as np

    found: NDArray[Any] = np.eye(4)
    for each in path:
        found = matrix(each) @ found
    return found


def _path(known: dict[str, Transform], frame: str) -> list[Transform]:
    """From a frame up to its root. ValueError if there is none."""
    found: list[Transform] = []
    at = known.get(frame)
    while at is not None:
        found.append(at)
        if at.target == frame and len(found) > 1:
            raise ValueError(f'"{frame}" would be its own parent')
        if len(found) > LONGEST:
            raise ValueError(f"more than {LONGEST} frames in a row, or in a circle")
        at = known.get(at.source)
    return found


def _length(given: Transform) -> float:
    return hypot(given.qx, given.qy, given.qz, given.qw)
