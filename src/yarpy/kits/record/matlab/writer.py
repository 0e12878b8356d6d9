"""A file of robometry that is written: what ports sent as numbers, in a `.mat`, and its `.json`.

Rules: for one thread. Such a file has all numbers of a channel in one piece, so that it is written
at the end, and they wait in memory. A channel has messages of one size; all others, and what is no
numbers, are refused. Times are those of sending. Pictures of bytes are arrays of bytes: grey ones
of rows and columns, others with red, green, blue, and alpha if they have it, behind these.
"""

from __future__ import annotations

import json
import math
from array import array
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from yarpy.data.sig.image import Image
from yarpy.errors import DecodeError, LocalProtocolError, UnknownPlugin
from yarpy.kits.record.envelope import SECOND, fields_of
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.matlab.layout import (
    DESCRIPTION,
    ENDING,
    NAMED,
    NEEDS,
    ROBOT,
    configuration,
    field_name,
    place,
)
from yarpy.kits.record.recorded import Recorded


class _Channel:
    """The samples of a port, all of one shape and kind."""

    def __init__(self, shape: tuple[int, ...], kind: np.dtype[Any]) -> None:
        self.shape = shape
        self.kind = kind
        self.times: array[float] = array("d")
        self.numbers = bytearray()


class MatWriter:
    """New files NAME.mat and NAME.json. facts: `yarp_robot_name`, and `description_list`,
    `elements_names` and `units_of_measure` (by ports) as JSON.

    Raises FileExistsError, OSError; UnknownPlugin without the library.
    """

    def __init__(self, path: str | Path, facts: Mapping[str, str] | None = None) -> None:
        try:
            from scipy.io import savemat
        except ImportError:
            raise UnknownPlugin(NEEDS) from None
        self._save: Any = savemat
        where = Path(path)
        where = where.with_suffix("") if where.suffix == ENDING else where
        where.parent.mkdir(parents=True, exist_ok=True)
        self.path = where.with_name(f"{where.name}{ENDING}")
        self._described = where.with_name(f"{where.name}.json")
        for file in (self.path, self._described):
            file.open("xb").close()
        self._facts = {**(facts or {})}
        self._channels: dict[str, _Channel] = {}
        self._closed = False

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message. Raises LocalProtocolError for what is no numbers, or not as many as those
        before."""
        recorded = Recorded(port, received, 0, envelope, payload)
        try:
            found = _numbers(recorded)
        except (DecodeError, TypeError, ValueError) as error:
            raise LocalProtocolError(f"{port}: no numbers: {error}") from None
        shape = found.shape if found.ndim > 1 else (found.size, 1)
        known = self._channels.get(port)
        if not found.size or (known and (known.shape, known.kind) != (shape, found.dtype)):
            raise LocalProtocolError(f"{port}: a message of another size")
        if known is None:
            known = self._channels[port] = _Channel(shape, found.dtype)
        known.times.append(fields_of(envelope, received, 0)[2] / SECOND)
        known.numbers += found.tobytes(order="F")

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Leave a note out."""

    def close(self) -> None:
        """Write the files. Raises OSError."""
        if self._closed:
            return
        self._closed = True
        elements, units = (self._told(name) for name in ("elements_names", "units_of_measure"))
        tree: dict[str, Any] = {}
        for port, channel in self._channels.items():
            size, count = math.prod(channel.shape), len(channel.times)
            named = _fitting(elements, port, size) or [f"element_{n}" for n in range(size)]
            measured = _fitting(units, port, size) or ["n.d."] * size
            if size > NAMED:
                named, measured = [], []
            numbers = np.frombuffer(channel.numbers, channel.kind)
            leaf = {
                "data": numbers.reshape(*channel.shape, count, order="F"),
                "dimensions": np.array([*channel.shape, count], "u8"),
                "elements_names": _cells(named),
                "units_of_measure": _cells(measured),
                "name": port,
                "timestamps": np.array(channel.times),
            }
            place(tree, port, leaf)
        name, robot, described = (
            field_name(self.path.stem),
            self._facts.get(ROBOT, ""),
            self._told(DESCRIPTION),
        )
        lines = [*map(str, described)] if isinstance(described, list) else []
        whole = {DESCRIPTION: _cells(lines or [""]), ROBOT: robot, **tree}
        name = field_name(self.path.stem)
        self._save(self.path, {name: whole}, long_field_names=True, oned_as="row")
        text = json.dumps(configuration(self.path.stem, robot, lines, tree), indent=1)
        self._described.write_text(text, encoding="utf-8")

    def _told(self, name: str) -> Any:
        """Return what a fact says, as JSON."""
        try:
            return json.loads(self._facts.get(name, "null"))
        except (ValueError, RecursionError):
            return None


def _numbers(recorded: Recorded) -> NDArray[Any]:
    """Return a message as numbers: float64, bytes of a picture. Raises DecodeError, TypeError,
    ValueError."""
    if kind_of(recorded.payload) == "yarp/image":
        image = recorded.as_(Image)
        if image.array.dtype == np.uint8:
            swapped = {"bgr": "rgb", "bgra": "rgba"}.get(str(image.code))
            return np.asarray(image.converted(swapped).array if swapped else image.array)
    return np.asarray(recorded.as_(np.ndarray), "f8")


def _cells(texts: list[str]) -> Any:
    """Return an array of cells: a column."""
    return np.array(texts, object).reshape(-1, 1)


def _fitting(told: Any, port: str, size: int) -> list[str]:
    """Return the names of a port if they are as many as its numbers; else none."""
    names = told.get(port) if isinstance(told, dict) else None
    return [*map(str, names)] if isinstance(names, list) and len(names) == size else []
