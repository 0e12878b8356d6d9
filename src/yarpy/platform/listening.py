"""The process that listens to a TCP port of this computer.

    Windows         every user may ask that of all processes
    Linux, macOS    nobody says it here: /proc has that of our own processes, and more

Rules: a look, which may be over by now.
"""

from __future__ import annotations

import sys
from typing import Final

if sys.platform == "win32":
    _LISTENERS: Final = 3  # TCP_TABLE_OWNER_PID_LISTENER
    _SHORT: Final = 122  # ERROR_INSUFFICIENT_BUFFER
    #: of both kinds of addresses: words in a row, and the places of its port and its process
    _KINDS: Final = ((2, 6, 2, 5), (23, 14, 5, 13))

    def listening() -> dict[int, int]:
        """Return the process of each number that somebody listens to."""
        found: dict[int, int] = {}
        for family, size, port, owner in _KINDS:
            words = _table(family)
            for at in range(1, len(words) - size + 1, size):
                number = words[at + port]
                found.setdefault((number & 0xFF) << 8 | (number >> 8) & 0xFF, words[at + owner])
        return found

    def _table(family: int) -> list[int]:
        """Return the words of a table: how many rows it has, and then these."""
        import ctypes

        ask = ctypes.WinDLL("iphlpapi").GetExtendedTcpTable
        size = ctypes.c_ulong(0)
        words = (ctypes.c_uint32 * 1)()
        for _ in range(10):  # it may grow between asking for its size and for itself
            code = ask(words, ctypes.byref(size), False, family, _LISTENERS, 0)
            if code == 0:
                given = list(words)
                return given[: 1 + given[0] * next(each[1] for each in _KINDS if each[0] == family)]
            if code != _SHORT:
                break
            words = (ctypes.c_uint32 * (size.value // 4 + 1))()
        return [0]

else:

    def listening() -> dict[int, int]:
        """Return the process of each number that somebody listens to."""
        return {}
