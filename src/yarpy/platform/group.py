"""Groups of processes: a program and all that it starts, who are asked to end, or ended, together.

    Linux, macOS    a session, whose processes get signals; whoever begins another one is out of it
    Windows         a process group, which Ctrl-Break of their common console reaches, and a job,
                    which nobody gets out of. It ends with the process that holds it, even if that
                    one is killed: nothing is left

Rules: a program is started with `START`, and made a group at once: on Windows it does nothing
before. Where there is no console, nobody can be asked, and a program that is asked to end is ended.
Whoever has gone is no error.
"""

from __future__ import annotations

import signal
import subprocess
import sys
from typing import Any, Final

from yarpy.platform.process import signal_group

if sys.platform == "win32":
    import ctypes

    _SUSPENDED: Final = 0x0000_0004  # CREATE_SUSPENDED: until it is in the job
    #: what `subprocess.Popen` is told
    START: Final[dict[str, Any]] = {
        "creationflags": subprocess.CREATE_NEW_PROCESS_GROUP | _SUSPENDED
    }

    _BREAK = int(signal.CTRL_BREAK_EVENT)  # what a process group does not ignore; Ctrl-C it does
    _ASKS: Final = (signal.SIGTERM, signal.SIGINT, signal.SIGBREAK)
    _ACCESS: Final = 0x0901  # PROCESS_TERMINATE, PROCESS_SET_QUOTA, PROCESS_SUSPEND_RESUME
    _KILL_ON_CLOSE: Final = 0x2000  # JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE
    _PROCESSES: Final = 3  # JobObjectBasicProcessIdList
    _LIMITS: Final = 9  # JobObjectExtendedLimitInformation
    _MOST: Final = 4096  # processes of a group that are told

    class _Limits(ctypes.Structure):
        _fields_ = (
            ("process_time", ctypes.c_longlong),
            ("job_time", ctypes.c_longlong),
            ("flags", ctypes.c_ulong),
            ("least", ctypes.c_size_t),
            ("most", ctypes.c_size_t),
            ("processes", ctypes.c_ulong),
            ("affinity", ctypes.c_size_t),
            ("priority", ctypes.c_ulong),
            ("scheduling", ctypes.c_ulong),
            ("io", ctypes.c_ulonglong * 6),
            ("memory", ctypes.c_size_t * 4),
        )

    class _Members(ctypes.Structure):
        _fields_ = (
            ("assigned", ctypes.c_ulong),
            ("listed", ctypes.c_ulong),
            ("pids", ctypes.c_size_t * _MOST),
        )

    class Group:
        """A program that was started with `START`, and all that it starts. Raises OSError, and then
        the program does nothing, and is to be ended."""

        def __init__(self, pid: int) -> None:
            self.pid = pid
            self._kernel = ctypes.WinDLL("kernel32", use_last_error=True)
            self._kernel.CreateJobObjectW.restype = ctypes.c_void_p
            self._kernel.OpenProcess.restype = ctypes.c_void_p
            self._job = ctypes.c_void_p(self._kernel.CreateJobObjectW(None, None))
            limits = _Limits(flags=_KILL_ON_CLOSE)
            first = ctypes.c_void_p(self._kernel.OpenProcess(_ACCESS, False, pid))
            try:
                done = (
                    self._kernel.SetInformationJobObject(
                        self._job, _LIMITS, ctypes.byref(limits), ctypes.sizeof(limits)
                    )
                    and self._kernel.AssignProcessToJobObject(self._job, first)
                    and ctypes.WinDLL("ntdll").NtResumeProcess(first) >= 0
                )
                if not done:
                    raise ctypes.WinError(ctypes.get_last_error())
            finally:
                self._kernel.CloseHandle(first)

        def __del__(self) -> None:
            """Let go of the job, which ends with whoever is in it."""
            self._kernel.CloseHandle(self._job)

        def signal(self, number: int) -> bool:
            """Ask all to end, or end them with any number that asks for nothing; return whether
            there was one."""
            if not self.members():
                return False
            if number not in _ASKS or not self._kernel.GenerateConsoleCtrlEvent(_BREAK, self.pid):
                self._kernel.TerminateJobObject(self._job, number)
            return True

        def members(self) -> list[int]:
            """Return those that live."""
            found = _Members()
            self._kernel.QueryInformationJobObject(
                self._job, _PROCESSES, ctypes.byref(found), ctypes.sizeof(found), None
            )
            return [*found.pids[: found.listed]]

else:
    START: Final[dict[str, Any]] = {"start_new_session": True}

    class Group:
        """A program that was started with `START`, and all that it starts."""

        def __init__(self, pid: int) -> None:
            self.pid = pid

        def signal(self, number: int) -> bool:
            """Send all a signal; return whether there was one."""
            return signal_group(self.pid, number)

        def members(self) -> list[int]:
            """Return those that live: minus the number of the group, which stands for all."""
            return [-self.pid] if signal_group(self.pid, 0) else []
