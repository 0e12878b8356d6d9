"""Joints of several control boards as one board, in any order: controlboardremapper in C++.

    with remap_remote(["/icub/torso", "/icub/head"], ["neck_pitch", "torso_yaw"]) as board:
        board.position_move("torso_yaw", 20.0)

    remap([torso, head], ["neck_pitch", "torso_yaw"])       boards of this program, or clients

Rules: it has the members of `control_board.interface` that all boards with one of its joints have,
and is a device itself, which can be served. Each board is asked once for all of its joints. What
belongs to no joint (`variables`, `calibrate_joint`) stays with the boards.

Source: remotecontrolboardremapper of YARP 3.x and 4.0.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from typing import Any, Final

from yarpy.kits.devices.closeable import local_prefix
from yarpy.kits.devices.control_board.client import ControlBoard
from yarpy.kits.devices.control_board.interface import ControlBoardLike, PidController
from yarpy.names.base import NameClient

#: Members that are not about one joint each, or have a form of their own.
_OTHERS: Final = frozenset(("axis_names", "pids", "variables", "calibrate_joint", "quit_parking"))


def _members(protocol: type[Any]) -> dict[str, str]:
    """The members of a protocol, and what each is: measured, commanded with values, set ..."""
    found = {}
    for base in reversed(protocol.__mro__):
        for name in vars(base).get("__annotations__", {}):
            found[name] = "set"
        for name, value in vars(base).items():
            if inspect.isfunction(value) and not name.startswith("_"):
                names = [*inspect.signature(value).parameters][1:]
                if not names:
                    found[name] = "measured"
                elif names[0] == "joints":
                    found[name] = "commanded" if len(names) > 1 else "done"
                elif names == ["joint"]:
                    found[name] = "asked"
    return {
        name: form
        for name, form in found.items()
        if name not in _OTHERS and not name.startswith("quit_")
    }


class _Places:
    """The board of each joint, and the joint's number there."""

    def __init__(self, boards: Sequence[Any], axes: Sequence[str]) -> None:
        known: dict[str, tuple[int, int]] = {}
        for at, board in enumerate(boards):
            for joint, name in enumerate(board.axis_names):
                if name in known and name in axes:
                    raise ValueError(f'two boards have a joint "{name}"')
                known[name] = (at, joint)
        missing = [name for name in axes if name not in known]
        if missing or not axes:
            there = ", ".join(known)
            raise ValueError(f"no board has the joints {', '.join(missing)}; there are {there}")
        if len({*axes}) != len(axes):
            raise ValueError("a joint is named twice")
        used = sorted({known[name][0] for name in axes})
        self.names = [*axes]
        self.boards = [boards[at] for at in used]
        self.places = [(used.index(known[name][0]), known[name][1]) for name in axes]

    def number(self, joint: Any) -> int:
        """The number of a joint, given by that or by its name."""
        if isinstance(joint, str):
            if joint not in self.names:
                raise LookupError(f'no joint "{joint}": there are {", ".join(self.names)}')
            return self.names.index(joint)
        if not 0 <= joint < len(self.names):
            raise IndexError(f"no joint {joint} (there are 0 to {len(self.names) - 1})")
        return int(joint)

    def numbers(self, which: Any) -> list[int]:
        """The numbers of one joint, or of several; None: all."""
        if which is None:
            return [*range(len(self.names))]
        one = isinstance(which, str) or not hasattr(which, "__len__")
        return [self.number(joint) for joint in ([which] if one else which)]

    def groups(self, joints: Sequence[int]) -> Iterator[tuple[int, list[int], list[int]]]:
        """For each board its number, its joints, and which of those that are given they are."""
        for at in range(len(self.boards)):
            which = [i for i, joint in enumerate(joints) if self.places[joint][0] == at]
            if which:
                yield at, [self.places[joints[i]][1] for i in which], which


class RemappedBoard:
    """The base of these boards; their members are added for what their boards can do."""

    def __init__(self, places: _Places, parts: Sequence[Any], resources: ExitStack) -> None:
        self._places = places
        self._parts = parts
        self._resources = resources

    def __repr__(self) -> str:
        return f"<RemappedBoard {', '.join(self._places.names)}>"

    def close(self) -> None:
        """Close the clients that it has made. Idempotent."""
        self._resources.close()

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def _measured(name: str) -> Any:
    def measured(self: RemappedBoard) -> list[Any]:
        return _gather(self, name, lambda part: getattr(part, name)())

    return measured


def _commanded(name: str) -> Any:
    def commanded(self: RemappedBoard, joints: Any, values: Any) -> None:
        numbers = self._places.numbers(joints)
        many = hasattr(values, "__len__") and not isinstance(values, str)
        row = [*values] if many else [values] * len(numbers)
        if len(row) != len(numbers):
            raise ValueError(f"{len(row)} values for {len(numbers)} joints")
        for at, there, which in self._places.groups(numbers):
            getattr(self._parts[at], name)(there, [row[i] for i in which])

    return commanded


def _done(name: str) -> Any:
    def done(self: RemappedBoard, joints: Any = None) -> None:
        for at, there, _ in self._places.groups(self._places.numbers(joints)):
            getattr(self._parts[at], name)(there)

    return done


def _asked(name: str) -> Any:
    def asked(self: RemappedBoard, joint: Any) -> Any:
        at, there = self._places.places[self._places.number(joint)]
        return getattr(self._parts[at], name)(there)

    return asked


def _set(name: str) -> Any:
    def read(self: RemappedBoard) -> tuple[Any, ...]:
        return tuple(_gather(self, name, lambda part: getattr(part, name)))

    def write(self: RemappedBoard, values: Any) -> None:
        row = [*values]
        if len(row) != len(self._places.names):
            raise ValueError(f"{name}: {len(row)} values for {len(self._places.names)} joints")
        for at, there, which in self._places.groups([*range(len(row))]):
            part = self._parts[at]
            changed = [*getattr(part, name)]
            for joint, i in zip(there, which, strict=True):
                changed[joint] = row[i]
            setattr(part, name, changed)

    return property(read, write)


def _gather(self: RemappedBoard, name: str, read: Callable[[Any], Any]) -> list[Any]:
    rows = [[*read(part)] for part in self._parts]
    return [rows[at][joint] for at, joint in self._places.places]


_MAKE: Final = {
    "measured": _measured,
    "commanded": _commanded,
    "done": _done,
    "asked": _asked,
    "set": _set,
}


def remap(boards: Sequence[Any], axes: Sequence[str]) -> Any:
    """Return a board with these joints of other boards, see `ControlBoardLike`. ValueError: a joint
    that none of them has, or two."""
    return _remap(boards, axes, ExitStack())


def remap_remote(
    remotes: Sequence[str],
    axes: Sequence[str],
    local: str = "",
    *,
    carrier: str = "tcp",
    names: NameClient | None = None,
) -> Any:
    """Return a board with these joints of remote boards, whose ports begin with `remotes`.

    local: prefix of the clients' own ports; generated if empty. The others and the errors are those
    of `ControlBoard`, and of `remap`.
    """
    if not remotes:
        raise ValueError("the names of the boards are missing")
    local = local_prefix(local, "")
    with ExitStack() as resources:
        boards = [
            resources.enter_context(
                ControlBoard(remote, f"{local}{remote}", carrier=carrier, names=names)
            )
            for remote in remotes
        ]
        found = _remap(boards, axes, ExitStack())
        found._resources = resources.pop_all()
    return found


def _remap(boards: Sequence[Any], axes: Sequence[str], resources: ExitStack) -> Any:
    places = _Places(boards, axes)
    space = _space(ControlBoardLike, places.boards)
    space["axis_names"] = property(lambda self: [*self._places.names])
    if all(_has(board, "pids") for board in places.boards):
        space["pids"] = property(_pids)
    if all(_has(board, "quit_parking") for board in places.boards):
        space.update({name: _quit(name) for name in ("quit_parking", "quit_calibration")})
    kind = type("RemappedBoard", (RemappedBoard,), space)
    return kind(places, places.boards, resources)


def _space(protocol: type[Any], parts: Sequence[Any]) -> dict[str, Any]:
    """The members of a protocol that all parts have."""
    return {
        name: _MAKE[form](name)
        for name, form in _members(protocol).items()
        if all(_has(part, name) for part in parts)
    }


def _pids(self: RemappedBoard) -> Mapping[str, Any]:
    maps = [part.pids for part in self._parts]
    kinds = [kind for kind in maps[0] if all(kind in each for each in maps)]
    found = {}
    for kind in kinds:
        parts = [each[kind] for each in maps]
        made = type("RemappedPids", (RemappedBoard,), _space(PidController, parts))
        found[kind] = made(self._places, parts, ExitStack())
    return found


def _quit(name: str) -> Any:
    def stop(self: RemappedBoard) -> None:
        for part in self._parts:
            getattr(part, name)()

    return stop


def _has(part: Any, name: str) -> bool:
    # As in `Access`: reading a property of a remote board takes long, and may fail just now.
    return hasattr(type(part), name) or hasattr(part, name)
