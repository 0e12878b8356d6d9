"""Scheduling of one thread of this process: who runs first where processors are full.

    Linux       a policy for each thread: 0 (OTHER), 1 (FIFO), 2 (RR), with a priority of 1..99
    Windows     a level for each thread; those of one level take turns, as with RR. Priorities 1..33
                are the level above normal, 34..66 the highest, 67..99 the time-critical one
    others      nothing

Rules: a thread is called by the number that `Thread.native_id` has; 0 is the caller. What is read
back is what the system does, not what was asked: on Windows RR, with the least priority of a level.
"""

from __future__ import annotations

import os
import sys
from typing import Any, Final

if sys.platform == "win32":
    _ACCESS: Final = 0x0060  # THREAD_SET_INFORMATION, THREAD_QUERY_INFORMATION
    _UNKNOWN: Final = 0x7FFF_FFFF  # THREAD_PRIORITY_ERROR_RETURN
    _LEVELS: Final = ((67, 15), (34, 2), (1, 1))  # the least priority of each; 0 is normal

    #: what a person can do where the system refuses
    RIGHTS: Final = "run as an administrator"

    def schedule(thread: int, policy: int, priority: int) -> None:
        """Give a thread a policy and a priority. Raises PermissionError where the system refuses,
        OSError where it has no such thing."""
        if policy not in (0, 1, 2) or not 0 <= priority <= 99:
            raise OSError(f"no policy {policy} with the priority {priority}")
        level = next((level for least, level in _LEVELS if policy and priority >= least), 0)
        kernel, handle = _opened(thread)
        try:
            if not kernel.SetThreadPriority(handle, level):
                raise PermissionError
        finally:
            kernel.CloseHandle(handle)

    def scheduled(thread: int) -> tuple[int, int]:
        """Return the policy and the priority that a thread has. Raises OSError if there is none."""
        kernel, handle = _opened(thread)
        try:
            found = kernel.GetThreadPriority(handle)
        finally:
            kernel.CloseHandle(handle)
        if found == _UNKNOWN:
            raise OSError("the system does not tell the level of a thread")
        return next(((2, least) for least, level in _LEVELS if found >= level), (0, 0))

    def _opened(thread: int) -> tuple[Any, Any]:
        """The library, and a handle of a thread, which is to be closed."""
        import ctypes

        kernel = ctypes.WinDLL("kernel32")
        kernel.OpenThread.restype = ctypes.c_void_p
        number = thread or kernel.GetCurrentThreadId()
        handle = ctypes.c_void_p(kernel.OpenThread(_ACCESS, False, number))
        if not handle:
            raise OSError(f"there is no thread {number}")
        return kernel, handle

else:
    RIGHTS: Final = "run as root, grant CAP_SYS_NICE, or raise the rtprio limit (ulimit -r)"

    def schedule(thread: int, policy: int, priority: int) -> None:
        """Give a thread a policy and a priority. Raises PermissionError where the system refuses,
        OSError where it has no such thing, NotImplementedError on a system without it."""
        if sys.platform != "linux" or not hasattr(os, "sched_setscheduler"):
            raise NotImplementedError
        os.sched_setscheduler(thread, policy, os.sched_param(priority))

    def scheduled(thread: int) -> tuple[int, int]:
        """Return the policy and the priority that a thread has. Raises OSError if there is none."""
        if sys.platform != "linux" or not hasattr(os, "sched_getscheduler"):
            raise OSError("this system does not tell how a thread is scheduled")
        return os.sched_getscheduler(thread), os.sched_getparam(thread).sched_priority
