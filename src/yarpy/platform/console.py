"""The end of the console that a program of Windows was started from, or its being asked to end; and
of whoever reads what it prints.

    Windows         Ctrl-Break, which services and supervisors send, the end of the window, of the
                    session, of the computer: told in a thread of the system's, also while the main
                    thread sleeps, where no signal handler of Python would run
    Linux, macOS    nothing: that is a signal, SIGTERM or SIGHUP

A write to a pipe that nobody reads is EPIPE; the C library of Windows calls it an invalid argument.

Rules: what is told may take five seconds; then the process ends, whatever it is doing.
"""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable
from typing import Any, Final

_told: Final[list[Any]] = []  # what the system calls, which must not be collected

if sys.platform == "win32":
    _CTRL_C: Final = 0

    def is_unread(error: OSError) -> bool:
        """Return whether a write to a standard stream failed because nobody reads that any more."""
        return error.errno == errno.EINVAL and error.winerror is None  # a socket's has a number

    def at_end(act: Callable[[], object]) -> None:
        """Call `act` once the console ends or wants the process to; then it ends."""
        import ctypes

        def tell(event: int) -> int:
            if event != _CTRL_C:  # a KeyboardInterrupt, which ends the program as it likes
                act()
            return 0  # the next one may do something, too; the last of them ends the process

        told = ctypes.WINFUNCTYPE(ctypes.c_int, ctypes.c_uint)(tell)
        if ctypes.WinDLL("kernel32").SetConsoleCtrlHandler(told, True):
            _told.append(told)

else:

    def is_unread(error: OSError) -> bool:
        """Return whether a write to a standard stream failed because nobody reads that any more."""
        return error.errno == errno.EPIPE

    def at_end(act: Callable[[], object]) -> None:
        """Do nothing: here a signal tells that."""
