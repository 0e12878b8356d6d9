"""What the system lacks that a test stands on: a reason to skip, "" where it is there."""

from __future__ import annotations

import ctypes
import os
import signal
import socket
import sys
from typing import Final

NO_UNIX_SOCKETS: Final = "" if hasattr(socket, "AF_UNIX") else "Windows' Python has no Unix sockets"
NO_ROOT: Final = (
    ""
    if hasattr(os, "getuid") and os.getuid() == 0
    else "it takes root of a Unix to act as somebody else"
)
NO_MEMFD: Final = "" if hasattr(os, "memfd_create") else "only Linux has memory with a descriptor"
NO_SCHEDULING: Final = (
    ""
    if sys.platform in ("linux", "win32")
    else "this system does not let a program say which of its threads runs first"
)
NO_POLICIES: Final = (
    "" if sys.platform == "linux" else "only Linux has policies for threads; Windows has levels"
)
NO_MARKS: Final = (
    "" if sys.platform != "win32" else "Windows marks packets by its administrator's policies alone"
)
NO_TAKEN: Final = "" if sys.platform == "linux" else "only Linux tells how much a peer has taken"
NO_LINKS: Final = "" if sys.platform != "win32" else "on Windows it takes a right to make a link"
NO_UNLINK: Final = (
    "" if sys.platform != "win32" else "Windows lets nobody delete a file that a program has open"
)
NO_OWNERS: Final = (
    "under wine sockets are its server's, and it says of nobody who listens"
    if sys.platform == "win32" and hasattr(ctypes.WinDLL("ntdll"), "wine_get_version")
    else "macOS says who listens to nobody but root"
    if sys.platform == "darwin"
    else ""
)
NO_RUN_SERVER: Final = (
    "" if sys.platform != "win32" else "yarpy run --server needs Linux, macOS or another Unix"
)
NO_TIMER: Final = "" if hasattr(signal, "SIGALRM") else "Windows has no timer that sends signals"
NO_GROUPS: Final = (
    ""
    if sys.platform != "win32"
    else "under wine a member of a multicast group is told after a while that its host is gone"
)
