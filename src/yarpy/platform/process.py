"""Other processes: whether one lives, and signals to it and to those whom it started.

    Linux, macOS    signals, to one process or to all of a group
    Windows         neither: a process is looked at by a handle, and can only be ended

Rules: whoever has gone is no error.
"""

from __future__ import annotations

import os
import signal
import sys
from typing import Final

if sys.platform == "win32":
    #: what no program can refuse: any number but those of Ctrl-C and Ctrl-Break
    KILL: Final = 9

    _QUERY: Final = 0x1000  # PROCESS_QUERY_LIMITED_INFORMATION
    _DENIED: Final = 5  # ERROR_ACCESS_DENIED
    _RUNS: Final = 259  # STILL_ACTIVE
    _PATH: Final = 1 << 15  # letters of the longest one
    _PROCESSES: Final = 2  # TH32CS_SNAPPROCESS

    def lives(pid: int) -> bool:
        """Return whether there is a process with that number. `os.kill(pid, 0)` would be Ctrl-C."""
        import ctypes

        kernel = ctypes.WinDLL("kernel32", use_last_error=True)
        kernel.OpenProcess.restype = ctypes.c_void_p
        handle = ctypes.c_void_p(kernel.OpenProcess(_QUERY, False, pid))
        if not handle:
            return ctypes.get_last_error() == _DENIED  # somebody else's
        try:
            code = ctypes.c_ulong()
            return bool(kernel.GetExitCodeProcess(handle, ctypes.byref(code))) and (
                code.value == _RUNS
            )
        finally:
            kernel.CloseHandle(handle)

    def program(pid: int) -> str:
        """Return the path of the program that a process runs; "" if the system does not say it."""
        import ctypes

        kernel = ctypes.WinDLL("kernel32")
        kernel.OpenProcess.restype = ctypes.c_void_p
        handle = ctypes.c_void_p(kernel.OpenProcess(_QUERY, False, pid))
        if not handle:
            return ""
        try:
            text, size = ctypes.create_unicode_buffer(_PATH), ctypes.c_ulong(_PATH)
            told = kernel.QueryFullProcessImageNameW(handle, 0, text, ctypes.byref(size))
            return text.value if told else ""
        finally:
            kernel.CloseHandle(handle)

    def ancestors() -> list[str]:
        """Return the names of the files of the programs that have led to this one: of who has
        started it, of who has started that, and on until one that has ended."""
        import ctypes
        from ctypes import wintypes

        class Entry(ctypes.Structure):
            _fields_ = (
                ("size", wintypes.DWORD),
                ("usage", wintypes.DWORD),
                ("pid", wintypes.DWORD),
                ("heap", ctypes.c_size_t),
                ("module", wintypes.DWORD),
                ("threads", wintypes.DWORD),
                ("parent", wintypes.DWORD),
                ("priority", wintypes.LONG),
                ("flags", wintypes.DWORD),
                ("file", wintypes.WCHAR * 260),
            )

        kernel = ctypes.WinDLL("kernel32")
        kernel.CreateToolhelp32Snapshot.restype = ctypes.c_void_p
        snapshot = ctypes.c_void_p(kernel.CreateToolhelp32Snapshot(_PROCESSES, 0))
        entry, all_of_them = Entry(ctypes.sizeof(Entry)), dict[int, tuple[int, str]]()
        more = kernel.Process32FirstW(snapshot, ctypes.byref(entry))
        while more:
            all_of_them[entry.pid] = entry.parent, entry.file
            more = kernel.Process32NextW(snapshot, ctypes.byref(entry))
        kernel.CloseHandle(snapshot)
        names, pid = list[str](), os.getpid()
        while pid in all_of_them:
            pid, _ = all_of_them.pop(pid)
            if pid in all_of_them:
                names.append(all_of_them[pid][1])
        return names

    def signal_group(pid: int, number: int) -> bool:
        """Send a signal to all whom a process leads; return whether there is one. 0 asks only."""
        return signal_one(pid, number) if number else lives(pid)

    def signal_one(pid: int, number: int) -> bool:
        """Send a process a signal; return whether there is one that can be sent it."""
        if not lives(pid):  # somebody may hold a handle of one that has ended
            return False
        try:
            os.kill(pid, number)
        except OSError:
            return False
        return True

    def in_group(pid: int, leader: int) -> bool:
        """Return whether a process belongs to the group of another one."""
        return pid == leader

    def go_on(pid: int) -> None:
        """Have a process go on that was stopped."""

else:
    #: what no program can refuse
    KILL: Final = signal.SIGKILL

    def lives(pid: int) -> bool:
        """Return whether there is a process with that number."""
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return False
        except OSError:
            return True  # somebody else's
        return True

    def program(pid: int) -> str:
        """Return the path of the program that a process runs; "" if the system does not say it."""
        try:
            return os.readlink(f"/proc/{pid}/exe")
        except OSError:
            return ""

    def signal_group(pid: int, number: int) -> bool:
        """Send a signal to all whom a process leads; return whether there is one. 0 asks only."""
        try:
            os.killpg(pid, number)
        except (ProcessLookupError, PermissionError):
            return False  # it has ended, or has become another user's
        return True

    def signal_one(pid: int, number: int) -> bool:
        """Send a process a signal; return whether there is one that can be sent it."""
        try:
            os.kill(pid, number)
        except (ProcessLookupError, PermissionError):
            return False
        return True

    def in_group(pid: int, leader: int) -> bool:
        """Return whether a process belongs to the group of another one."""
        try:
            return os.getpgid(pid) == leader
        except OSError:
            return False

    def go_on(pid: int) -> None:
        """Have a process go on that was stopped."""
        signal_one(pid, signal.SIGCONT)
