"""The facts of a computer: the message that C++ yarprun answers `sysinfo` with.

Rules: it is no Bottle, but numbers, and texts with a line end, one after the other, in the order of
the fields of C++; programs that take any message for a Bottle cannot read it. What this system does
not tell is 0 or empty. Sizes are in MB.
"""

from __future__ import annotations

import os
import platform
import shutil
import struct
from contextlib import suppress
from pathlib import Path
from typing import Final

from yarpy.wire.message import Encoded

_MB: Final = 1 << 20
_EOL: Final = b"\r\n"

#: The fields in their order: i is a number of 32 bits, d one of 64, s a text.
FIELDS: Final = (
    *(("memory total", "i"), ("memory free", "i"), ("disk total", "i"), ("disk free", "i")),
    *(("architecture", "s"), ("model", "s"), ("vendor", "s"), ("family", "i")),
    *(("model number", "i"), ("cores", "i"), ("siblings", "i"), ("MHz", "d")),
    *(("load 1", "d"), ("load 5", "d"), ("load 15", "d"), ("load now", "i")),
    *(("system", "s"), ("distribution", "s"), ("release", "s"), ("codename", "s")),
    *(("kernel", "s"), ("environment", "s")),
    *(("user", "s"), ("user name", "s"), ("home", "s"), ("user id", "i")),
)


def described() -> Encoded:
    """Return the message that says what this computer is."""
    found = _facts()
    parts = []
    for name, kind in FIELDS:
        value = found.get(name)
        if kind == "s":
            parts.append(str(value or "").encode() + _EOL)
        else:
            parts.append(struct.pack(f"<{kind}", value or 0))
    return Encoded(b"".join(parts))


def _facts() -> dict[str, str | int | float]:
    memory = _table("/proc/meminfo", {"MemTotal", "MemFree"})
    wanted = {"model name", "vendor_id", "cpu family", "model", "cpu cores", "siblings", "cpu MHz"}
    processor = _table("/proc/cpuinfo", wanted)
    release = _table("/etc/os-release", {"ID", "VERSION_ID", "VERSION_CODENAME"}, "=")
    disk = shutil.disk_usage(Path.cwd().anchor or "/")
    loads = os.getloadavg() if hasattr(os, "getloadavg") else (0.0, 0.0, 0.0)
    return {
        "memory total": _number(memory.get("MemTotal")) // 1024,
        "memory free": _number(memory.get("MemFree")) // 1024,
        "disk total": disk.total // _MB,
        "disk free": disk.free // _MB,
        "architecture": platform.machine(),
        "model": processor.get("model name", ""),
        "vendor": processor.get("vendor_id", ""),
        "family": _number(processor.get("cpu family")),
        "model number": _number(processor.get("model")),
        "cores": _number(processor.get("cpu cores")),
        "siblings": _number(processor.get("siblings")) or os.cpu_count() or 0,
        "MHz": float(_number(processor.get("cpu MHz"))),
        "load 1": loads[0],
        "load 5": loads[1],
        "load 15": loads[2],
        "load now": round(loads[0]),
        "system": platform.system(),
        "distribution": release.get("ID", ""),
        "release": release.get("VERSION_ID", ""),
        "codename": release.get("VERSION_CODENAME", ""),
        "kernel": platform.release(),
        "user": _user(),
        "home": str(Path.home()),
        "user id": os.getuid() if hasattr(os, "getuid") else 0,
    }


def _table(path: str, names: set[str], mark: str = ":") -> dict[str, str]:
    """Return the first value of each name in a file of the system."""
    found: dict[str, str] = {}
    with suppress(OSError), open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            name, _, value = line.partition(mark)
            if name.strip() in names:
                found.setdefault(name.strip(), value.strip().strip('"'))
    return found


def _number(text: str | None) -> int:
    first = (text or "").partition(" ")[0].partition(".")[0]
    return int(first) if first.isdigit() else 0


def _user() -> str:
    import getpass

    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return ""
