"""Descriptors that close with their object, whatever comes between.

Rules: a signal handler may raise between any two steps of Python in the main thread, also where a
call of the system has just returned, and within `__del__`. So a descriptor becomes an object in the
same call into C in which it is made, and its end is one of C as well. What takes more than that is
done `undisturbed`, in a thread where no handler runs.
"""

from __future__ import annotations

import os
import select
import sys
from collections.abc import Callable, Iterable
from io import FileIO
from itertools import chain
from typing import Any


class Descriptor(FileIO):
    """A descriptor of this process, which is closed with it. Raises OSError for one of a
    directory, or none; that stays open."""

    __del__ = FileIO.close  # no function of Python, which a signal could cut at its first step


def opened(make: Callable[..., int], *arguments: Any) -> Descriptor:
    """Return the descriptor that make(*arguments) returns. Raises what that raises."""
    (found,) = map(Descriptor, map(make, *((each,) for each in arguments)))
    return found


def opened_pair(make: Callable[..., tuple[int, int]], *arguments: Any) -> list[Descriptor]:
    """Return the two descriptors that make(*arguments) returns. Raises what that raises."""
    made = map(make, *((each,) for each in arguments))
    return list(map(Descriptor, chain.from_iterable(made)))


def owned(numbers: Iterable[int]) -> list[Descriptor]:
    """Return these descriptors as objects. Raises OSError if one is none, or a directory; then all
    are closed."""
    rest, found = [*numbers], list[Descriptor]()
    try:
        found.extend(map(Descriptor, rest))
    except OSError:
        for number in rest[len(found) :]:
            os.close(number)
        raise
    return found


def has_input(number: int, seconds: float) -> bool:
    """Return whether there is something to read, or somebody to accept, within that time. The
    number may be any: `select` takes those below 1024 alone."""
    if sys.platform == "win32" or not hasattr(select, "poll"):
        return bool(select.select([number], [], [], seconds)[0])
    poll = select.poll()
    poll.register(number, select.POLLIN)
    return bool(poll.poll(seconds * 1000))
