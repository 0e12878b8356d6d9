"""Sessions of Zenoh as tests see them: what a question brings, which sockets are open."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any


def ask(session: Any, key: str) -> list[bytes]:
    return [reply.ok.payload.to_bytes() for reply in session.get(key, timeout=5)]


def listening() -> set[str]:
    """The listening sockets of this process, as numbers of the system."""
    own = {link for fd in Path("/proc/self/fd").glob("*") if (link := linked(fd))}
    found = set()
    for table in ("tcp", "tcp6", "udp"):
        for line in Path(f"/proc/self/net/{table}").read_text(encoding="utf-8").splitlines()[1:]:
            words = line.split()
            if words[3] in ("0A", "07") and f"socket:[{words[9]}]" in own:
                found.add(f"{table} {words[1]}")
    return found


def linked(path: Path) -> str:
    try:
        return os.readlink(path)
    except OSError:  # closed meanwhile
        return ""
