"""The end of the console that a program of Windows was started from, or its being asked to end; and
of whoever reads what it prints; and what the console makes of escape sequences.

    Windows         Ctrl-Break, which services and supervisors send, the end of the window, of the
                    session, of the computer: told in a thread of the system's, also while the main
                    thread sleeps, where no signal handler of Python would run. Behind all but
                    Ctrl-Break the process ends, also one with a handler of its own for SIGBREAK
    Linux, macOS    nothing: that is a signal, SIGTERM or SIGHUP

A write to a pipe that nobody reads is EPIPE; the C library of Windows calls it an invalid argument.
Terminals obey escape sequences, such as the one that clears a line; the console of Windows prints
them until a program asks it not to.

Rules: what is told may take five seconds; then the process ends, whatever it is doing.
"""

from __future__ import annotations

import errno
import sys
from collections.abc import Callable
from typing import Any, Final, TextIO

_told: Final[list[Any]] = []  # what the system calls, which must not be collected

if sys.platform == "win32":
    _CTRL_C: Final = 0
    _CTRL_BREAK: Final = 1
    _ESCAPES: Final = 0x0004  # ENABLE_VIRTUAL_TERMINAL_PROCESSING

    def is_unread(error: OSError) -> bool:
        """Return whether a write to a standard stream failed because nobody reads that any more."""
        return error.errno == errno.EINVAL and error.winerror is None  # a socket's has a number

    def obey_escapes(stream: TextIO) -> None:
        """Have the console behind a stream obey escape sequences; nothing, where there is none."""
        import ctypes
        import msvcrt

        kernel, mode = ctypes.WinDLL("kernel32"), ctypes.c_ulong()
        handle = ctypes.c_void_p(msvcrt.get_osfhandle(stream.fileno()))
        if kernel.GetConsoleMode(handle, ctypes.byref(mode)):
            kernel.SetConsoleMode(handle, mode.value | _ESCAPES)

    def at_end(act: Callable[[bool], object]) -> None:
        """Call `act` once the console ends or wants the process to, with whether the process ends
        then whatever it is told."""
        import ctypes

        def tell(event: int) -> int:
            if event != _CTRL_C:  # a KeyboardInterrupt, which ends the program as it likes
                act(event != _CTRL_BREAK)
            return 0  # the next one may do something, too; the last of them ends the process

        told = ctypes.WINFUNCTYPE(ctypes.c_int, ctypes.c_uint)(tell)
        if ctypes.WinDLL("kernel32").SetConsoleCtrlHandler(told, True):
            _told.append(told)

else:

    def is_unread(error: OSError) -> bool:
        """Return whether a write to a standard stream failed because nobody reads that any more."""
        return error.errno == errno.EPIPE

    def obey_escapes(stream: TextIO) -> None:
        """Do nothing: terminals do."""

    def at_end(act: Callable[[bool], object]) -> None:
        """Do nothing: here a signal tells that."""
