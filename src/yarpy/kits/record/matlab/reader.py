"""Files of robometry that are read: a `.mat` of any version, or the `.json` that wrote some.

Rules: the library reads a whole file, which is refused if it would take too much memory. What it
makes of a damaged one becomes a DecodeError. A sample is a Vector, or a Matrix where it has rows
and columns, or a picture where these are bytes, or a text; other cells and structures are left out,
and told. Times are those of sending and of receipt.
"""

from __future__ import annotations

import heapq
import json
from collections.abc import Container, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from yarpy.data import codec
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.vector import Vector
from yarpy.errors import DecodeError, MissingFile, UnknownPlugin
from yarpy.kits.record.envelope import SECOND, stamp_text
from yarpy.kits.record.matlab.layout import CONFIGURATION, DESCRIPTION, ENDING, NEEDS, ROBOT, leaves
from yarpy.kits.record.matlab.size import check_size
from yarpy.kits.record.mcap.layout import Damaged
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.limit import RECORDED_TEXT
from yarpy.platform.refusal import reason


def files_of(path: Path) -> list[Path]:
    """Return the files that a configuration of robometry has written, in their order. Raises
    MissingFile, DecodeError."""
    if path.suffix != CONFIGURATION:
        return [path]
    try:
        with path.open("rb") as file:
            said = json.loads(file.read(RECORDED_TEXT))
        folder, name = said.get("path", ""), said["filename"]
        found = path.parent / folder / name
    except OSError as error:
        raise MissingFile(f"{path} cannot be read: {reason(error)}") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise DecodeError(f"{path}: no configuration of robometry: {error}") from error
    whole = found.with_name(f"{found.name}{ENDING}")
    series = [whole] if whole.exists() else sorted(found.parent.glob(f"{found.name}_*{ENDING}"))
    if not series:
        raise MissingFile(f"{path}: it has written no {found.name}{ENDING} in {found.parent}")
    return series


class MatStorage:
    """A file at `path`. Raises MissingFile; DecodeError if it is none of robometry,
    UnknownPlugin."""

    def __init__(self, path: str | Path) -> None:
        try:
            from pymatreader import read_mat
        except ImportError:
            raise UnknownPlugin(NEEDS) from None
        self.path = Path(path)
        self.complete = True
        self.damages: list[Damaged] = []
        try:
            self.size = self.path.stat().st_size
            check_size(self.path)
            found = read_mat(self.path)
        except DecodeError:
            raise
        except OSError as error:
            if error.errno is None:  # of the library for HDF5
                raise DecodeError(f"{path}: {error}") from error
            raise MissingFile(f"{path} cannot be read: {reason(error)}") from error
        except Exception as error:  # whatever the library raises for what a stranger wrote
            raise DecodeError(f"{path}: {error or type(error).__name__}") from error
        whole = {name: item for name, item in found.items() if not name.startswith("__")}
        self._series: dict[str, _Series] = {}
        elements: dict[str, list[str]] = {}
        units: dict[str, list[str]] = {}
        for tree in whole.values():
            for port, leaf in leaves(tree) if isinstance(tree, Mapping) else ():
                try:
                    self._series[port] = _Series(leaf)
                except (ValueError, TypeError, KeyError, OverflowError) as error:
                    self.damages.append(Damaged(0, f"{port}: {error}"))
                    continue
                elements[port] = _texts(leaf.get("elements_names"))
                units[port] = _texts(leaf.get("units_of_measure"))
        if not self._series and not self.damages:
            raise DecodeError(f"{path}: it has no channel of robometry")
        first: Any = next((tree for tree in whole.values() if isinstance(tree, Mapping)), {})
        self.facts: dict[str, str] = {
            ROBOT: str(first.get(ROBOT, "")),
            DESCRIPTION: json.dumps(_texts(first.get(DESCRIPTION))),
            "elements_names": json.dumps(elements),
            "units_of_measure": json.dumps(units),
        }

    @property
    def begin(self) -> int:
        """Return the first time, in nanoseconds; 0 if there is none."""
        return min((min(one.times) for one in self._series.values() if one.times), default=0)

    @property
    def end(self) -> int:
        """Return the last time, in nanoseconds; 0 if there is none."""
        return max((max(one.times) for one in self._series.values() if one.times), default=0)

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return its channels as ports, by their names."""
        return {
            port: PortFacts(port, [one.kind], len(one.times)) for port, one in self._series.items()
        }

    def messages(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these ports (None: all) from `begin` until before `end`."""
        series = [
            one.read(port, begin, end)
            for port, one in self._series.items()
            if ports is None or port in ports
        ]
        return heapq.merge(*series, key=lambda recorded: recorded.received_ns)

    def notes(self) -> list[dict[str, Any]]:
        """Return nothing: such a file has no notes."""
        return []

    def close(self) -> None:
        """Nothing stays open."""


class _Series:
    """The samples of a channel. Raises ValueError, TypeError, KeyError for what is none."""

    def __init__(self, leaf: Mapping[str, Any]) -> None:
        times = np.atleast_1d(np.asarray(leaf["timestamps"], "f8"))
        if times.ndim != 1 or not np.all((times >= 0) & (times < 1e10)):
            raise ValueError("its timestamps are no seconds")
        self.times = [round(float(time) * SECOND) for time in times]
        data = leaf["data"]
        if isinstance(data, str) or (isinstance(data, list) and all(map(_is_text, data))):
            self._data: Any = _texts(data)
            self.kind = "yarp/bottle"
            if len(self._data) != len(self.times):
                raise ValueError(f"{len(self._data)} texts with {len(self.times)} timestamps")
            return
        numbers = np.asarray(data)
        if numbers.dtype.kind not in "biuf":
            raise ValueError("neither numbers nor texts")
        shape = [int(size) for size in np.atleast_1d(leaf["dimensions"])]
        if shape[-1] != len(self.times) or min(shape) < 0:
            raise ValueError(f"dimensions {shape} with {len(self.times)} timestamps")
        self._data = np.moveaxis(numbers.reshape(shape), -1, 0)
        self._flat = sum(size > 1 for size in shape[:-1]) < 2
        pixels = len(shape) == 3 or (len(shape) == 4 and shape[2] in (3, 4))
        self._picture = numbers.dtype == np.uint8 and pixels and not self._flat
        if self._picture:
            self.kind = "yarp/image"
            return
        self._data = self._data.astype("f8")
        if not self._flat and self._data.ndim != 3:
            raise ValueError(f"samples with {self._data.ndim - 1} dimensions")
        self.kind = "yarp/vector" if self._flat else "yarp/matrix"

    def read(self, port: str, begin: int, end: int) -> Iterator[Recorded]:
        """Yield the messages of that time."""
        for number, time in enumerate(self.times):
            if not begin <= time < end:
                continue
            item: Any = self._data[number]
            if not isinstance(item, str) and self._picture:
                item = Image(np.ascontiguousarray(item))
            elif not isinstance(item, str):
                item = Vector(item.ravel(order="F")) if self._flat else Matrix(item)
            payload = b"".join(map(bytes, codec.encode(item)))
            yield Recorded(port, time, time, stamp_text(number, time), payload)


def _is_text(item: object) -> bool:
    return isinstance(item, str)


def _texts(item: object) -> list[str]:
    """Return the texts of a cell array; the library gives a single one as it is."""
    return [item] if isinstance(item, str) else [*map(str, item)] if isinstance(item, list) else []
