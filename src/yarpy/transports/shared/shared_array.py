"""Shared array: the one that every view of shared memory comes from, and how it is found again.

Rules: it says in whose memory it lies, and where. It lives for as long as any view of it: then what
was received is given back, and room that a program has filled itself is free again. Bytes that are
to be sent are followed back through the arrays that they are a view of, so memory is not looked up
by its address, and nothing has to be registered.
"""

from __future__ import annotations

import mmap
from collections.abc import Callable, Sequence
from typing import Any, Final, Protocol, TypeAlias
from weakref import WeakSet

from yarpy import fork
from yarpy.threads import imported
from yarpy.wire.stream import LARGE, Buffer

HEADROOM: Final = 256  # bytes before an array that is filled in place: for a message's head


class Source(Protocol):
    """A file in memory that payloads lie in."""

    @property
    def address(self) -> int:
        """The address where it is mapped here."""

    @property
    def descriptors(self) -> tuple[int, ...]:
        """The file; and a pipe, if somebody wants to know until when it is looked at."""


class WritableBlock(Protocol):
    """A piece of our own memory that a program fills."""

    def begin(self, head: bytes) -> bool:
        """Put that in front of the array; False if something else is there."""


class Lender(Protocol):
    """A record of the payloads in use, which a forked child leaves to its parent."""

    def disown(self) -> None:
        """From now on it is not."""


LENDERS: Final[WeakSet[Lender]] = WeakSet()


def _leave_to_parent() -> None:
    """In a forked process, which has a copy of each view of its parent: what ends here does not end
    there. It is registered before what closes the parent's ports here (`port/keep/fork.py`)."""
    for lender in tuple(LENDERS):
        lender.disown()


fork.after_in_child(_leave_to_parent)

Location: TypeAlias = tuple[Source, int, object]
"""The place of a payload in memory: its source, the offset there, and what keeps it there."""


_MADE: Final[dict[str, Any]] = {}  # the class, once somebody wants one


def shared_array_type() -> Any:
    """The class: an array, since these can be over a part of a file."""
    return _MADE.get("class") or _MADE.setdefault("class", _make())


def _make() -> Any:
    np = imported("numpy")

    class SharedArray(np.ndarray):  # type: ignore[misc, name-defined]
        """Bytes of shared memory; or, without a source, bytes in place of such."""

        source: Source | None = None
        offset: int = 0
        room: WritableBlock | None = None
        ended: Callable[[], object] | None = None  # called with its end

        def __del__(self) -> None:
            if self.ended is not None:
                self.ended()

    return SharedArray


def place_of(blocks: Sequence[Buffer]) -> Location | None:
    """Return the place where the bytes of these blocks lie one after the other in memory that can
    be shown to others; None if they do not.

    The last block is what lies there; what is in front of it is small, and lies before it or can be
    put there.
    """
    block = blocks[-1] if blocks else b""
    if type(block) is not memoryview or len(block) < LARGE:
        return None
    shared = _shared_array_of(block.obj)
    if shared is None or shared.source is None:
        return None
    source: Source = shared.source
    start = _address(block) - source.address
    first: int = shared.offset
    room: WritableBlock | None = shared.room
    head = blocks[0] if len(blocks) == 2 else b"".join(blocks[:-1])
    begin = start - len(head)
    if begin < first or len(head) > HEADROOM:
        return None
    if not head:
        pass
    elif room is not None and start == first + HEADROOM:
        if not room.begin(bytes(head)):
            return None
    elif memoryview(shared)[begin - first : start - first] != head:
        return None
    if room is None:
        return source, begin, shared
    _forbid(block.obj)
    return source, begin, room


def freeze(value: object, blocks: Sequence[Buffer]) -> None:
    """Forbid a program to change what it has filled and written: its readers look at it. `blocks`
    are its bytes."""
    _forbid(value)  # an array, even if it was copied all the same
    block = blocks[-1] if blocks else b""
    if type(block) is memoryview and block.obj is not value:
        _forbid(block.obj)


def _shared_array_of(one: Any) -> Any:
    """Return the shared array that something is a view of, by way of the arrays between; None if it
    is a view of something else."""
    shared = _MADE.get("class")
    if shared is None:
        return None  # there is none yet, and a writer need not wait for the import of numpy
    array = shared.__base__
    while type(one) is not shared:
        if isinstance(one, array):
            one = one.base
        elif type(one) is memoryview:
            one = one.obj
        else:
            return None
    return one


def _forbid(one: Any) -> None:
    """Let what is a view of a shared array, and all arrays between, not be written to any more."""
    shared = _shared_array_of(one)
    if shared is None or not shared.flags.writeable:
        return
    shared.setflags(write=False)
    while one is not shared:
        if type(one) is memoryview:
            one = one.obj
        else:
            one.setflags(write=False)
            one = one.base


def address_of(memory: mmap.mmap) -> int:
    """Return the address where a file is mapped."""
    np = imported("numpy")
    address: int = np.frombuffer(memory, np.uint8).__array_interface__["data"][0]
    return address


def _address(block: memoryview) -> int:
    whole: Any = block.obj
    if not (isinstance(whole, shared_array_type().__base__) and whole.nbytes == len(block)):
        numpy = imported("numpy")
        whole = numpy.frombuffer(block, numpy.uint8)
    address: int = whole.__array_interface__["data"][0]
    return address
