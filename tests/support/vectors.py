"""Golden rows: what C++ YARP 3.9.1 made of texts and objects (tests/golden/vectors)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

_FOLDER = Path(__file__).parent.parent / "golden" / "vectors"


def rows(name: str) -> list[dict[str, Any]]:
    """The rows of `bottle` (text, binary, printed, size, codes) or of `types`."""
    found: list[dict[str, Any]] = json.loads((_FOLDER / f"{name}.json").read_text())
    return found


def binaries() -> list[bytes]:
    """The different binary messages of both tables that are Bottles, shortest first."""
    # (C++ 3.9.1 forgets the count when it writes a Value that holds a list)
    not_bottles = ("sound", "pointcloud_xyz", "value_list")
    messages = {bytes.fromhex(row["binary"]) for row in rows("bottle")}
    messages |= {
        bytes.fromhex(row["binary"]) for row in rows("types") if row["type"] not in not_bottles
    }
    return sorted(messages, key=lambda message: (len(message), message))
