"""The addresses where ports listen: `YARPY_BIND`, in the environment of the program that opens
them.

(nothing)      on every IPv4 address of this computer, as C++ YARP
local          on the loopback: reachable from this computer only
192.168.1.7    on this address alone
"""

from __future__ import annotations

import os
from typing import Final

SETTING: Final = "YARPY_BIND"
LOOPBACK: Final = "127.0.0.1"


def listening_host() -> str:
    """The address to listen on; empty for all of them."""
    said = os.environ.get(SETTING, "").strip()
    if said in ("local", "localhost"):
        return LOOPBACK
    return "" if said in ("all", "0.0.0.0") else said


def reach() -> str:
    """Return which networks can reach the ports of this program, as a text for people."""
    host = listening_host()
    if not host:
        return "all networks"
    return "this computer alone" if host.startswith("127.") else f"the network of {host} alone"
