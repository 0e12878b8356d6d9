"""Every moment at which a signal handler may run in a call: there one does something, in each run
of a test at another of them.

    for moment in moments():
        with moment.interrupts(act):
            call()

Rules: CPython looks for signals where a call has returned, a function begins, and a loop goes back;
between two other instructions it does not. Only in the interpreted core (`support.build`).
"""

from __future__ import annotations

import dis
import gc
import re
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import CodeType, FrameType
from typing import Any, Final

from support.wait import HANG

WITHIN: Final = re.compile(r"[/\\]yarpy[/\\]|(^|[/\\])threading\.py$")
LOOKS: Final = ("CALL", "CALL_FUNCTION_EX", "RESUME", "JUMP_BACKWARD")


class Moment:
    """The one that comes after so many others. `came`: it has."""

    def __init__(self, number: int) -> None:
        self._left = number
        self.came = False

    @contextmanager
    def interrupts(
        self, act: Callable[[], object], within: re.Pattern[str] = WITHIN
    ) -> Iterator[None]:
        """Call `act` at this moment of the block, in a frame of such a file: by default of yarpy,
        or of `threading`. Garbage of other tests is not collected meanwhile: their `__del__` is
        such a frame, too."""

        def trace(frame: FrameType, event: str, argument: Any) -> Any:
            if not within.search(frame.f_code.co_filename):
                return None
            frame.f_trace_opcodes = True
            if event == "opcode" and frame.f_lasti in _moments(frame.f_code) and not self.came:
                self._left -= 1
                if self._left < 0:
                    self.came = True
                    sys.settrace(None)
                    act()
            return trace

        before, collects = sys.gettrace(), gc.isenabled()
        gc.disable()
        sys.settrace(trace)
        try:
            yield
        finally:
            sys.settrace(before)
            if collects:
                gc.enable()


def moments() -> Iterator[Moment]:
    """One after the other, until a run has none left. The first comes twice: CPython 3.12 tells
    nothing of a function that it traces for the first time."""
    yield Moment(0)
    number = 0
    while True:
        moment = Moment(number)
        yield moment
        if not moment.came:
            return
        number += 1


@cache
def _moments(code: CodeType) -> frozenset[int]:
    found, before = set(), ""
    for one in dis.get_instructions(code):
        if before in LOOKS:
            found.add(one.offset)
        before = one.opname
    return frozenset(found)


class Cut(Exception):
    """What a signal handler raises."""


def cut() -> None:
    """Raise it."""
    raise Cut


def elsewhere(act: Callable[[], object]) -> bool:
    """Return whether another thread comes back from `act`, which has to be true: no lock that it
    needs was left behind in this one."""
    found: list[object] = []
    thread = threading.Thread(target=lambda: found.append(act()), daemon=True)
    thread.start()
    thread.join(HANG)
    return any(found)
