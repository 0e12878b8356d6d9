"""Do what a signal handler does, at each place of some files where one could come, in turn.

Rules: Python looks for signals when a function begins, at the end of a call, and when a loop goes
on; in between it does not, and neither does this. It can only raise one instruction later, and
leaves out where another handler is in force there.
"""

from __future__ import annotations

import dis
import sys
from collections.abc import Callable
from functools import cache
from types import CodeType, FrameType
from typing import Any

from support.build import COMPILED

# Compiled code shows no steps; Python 3.13 not those of a function's first call, nor of some later.
ALL_SEEN = not COMPILED and sys.version_info < (3, 13)

_LOOKS = ("RESUME", "CALL", "CALL_FUNCTION_EX", "CALL_KW", "JUMP_BACKWARD")


class Cut(BaseException):
    """What the handler raises."""


@cache
def _names(code: CodeType) -> dict[int, tuple[str, int]]:
    """What is at each offset, and where an exception there leads."""
    table = [
        (one.start, one.end, one.target)
        for one in dis._parse_exception_table(code)  # type: ignore[attr-defined]
    ]

    def handler(offset: int) -> int:
        found = [target for start, end, target in table if start <= offset < end]
        return found[0] if found else -1

    return {one.offset: (one.opname, handler(one.offset)) for one in dis.get_instructions(code)}


def cut() -> None:
    """What most handlers of tests do."""
    raise Cut


def cut_at(
    number: int, act: Callable[[], object], *files: str, handle: Callable[[], object] = cut
) -> bool:
    """Call `act`, and `handle` at the place with that number, from 1, of those where frames of
    `files` (ends of their paths) look for signals; return whether there were so many."""
    seen = 0
    before: dict[FrameType, tuple[str, int]] = {}

    def look(frame: FrameType, event: str, argument: object) -> Any:
        nonlocal seen
        if event == "opcode":
            name, handler = before.get(frame, ("", -1))
            here = before[frame] = _names(frame.f_code).get(frame.f_lasti, ("", -1))
            if name in _LOOKS and handler == here[1]:
                seen += 1
                if seen == number:
                    sys.settrace(None)
                    handle()
        return look

    def enter(frame: FrameType, event: str, argument: object) -> Any:
        if not frame.f_code.co_filename.replace("\\", "/").endswith(files):
            return None
        frame.f_trace_opcodes = True
        return look

    outer = sys.gettrace()
    sys._getframe().f_trace_opcodes = (
        True  # Python 3.12 looks at the tracing's start who wants them
    )
    sys.settrace(enter)
    try:
        act()
    except Cut:
        return True
    finally:
        sys.settrace(outer)
    return seen >= number
