"""Recorded dialogues with C++ YARP 3.9.1: `tests/golden/captures/NAME.json`.

Rules: a capture is a list of steps, each the bytes of one side. Its `variable` field says which
bytes are the machine's or the moment's; `masked` blanks them on both sides of a comparison.
`groups.json` lists the names of the groups that the core has to answer for.
"""

import json
import re
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

CAPTURES = Path(__file__).parents[1] / "golden" / "captures"

_RANGE = re.compile(r"step (\d+) bytes (\d+)\.\.(\d+)")


@dataclass(frozen=True)
class Step:
    """What one side sent before the other did."""

    index: int
    sender: str
    """`a` dialled, `b` answered."""
    data: bytes
    connection: int
    """The dialogue's connections one after the other, from 0."""
    transport: str = ""
    """`tcp`, `udp datagram`, `unix` where a dialogue uses several."""
    whole: int = 0
    """The full length, where only the beginning of long data was kept; else 0."""


@dataclass(frozen=True)
class Capture:
    name: str
    steps: list[Step]
    variable: dict[int, list[tuple[int, int]]] = field(default_factory=dict)
    """Step -> ranges of bytes that differ from run to run."""
    ports: dict[str, int] = field(default_factory=dict)
    """`initiator_port` and `acceptor_port` of the TCP connection, where known."""
    ends: list[tuple[str, int]] = field(default_factory=list)
    """Who hung up, after how many steps."""
    roles: dict[str, str] = field(default_factory=dict)
    """What `a` and `b` were, in words."""

    def masked(self, step: Step, data: bytes) -> bytes:
        """`data` with the variable ranges of `step` blanked, for comparing with its bytes."""
        blank = bytearray(data)
        for start, end in self.variable.get(step.index, ()):
            end = min(end, len(blank))
            blank[start:end] = b"?" * max(0, end - start)
        return bytes(blank)

    def said(self, sender: str) -> bytes:
        """Everything one side sent."""
        return b"".join(step.data for step in self.steps if step.sender == sender)


@cache
def load_capture(name: str) -> Capture:
    """Read one capture."""
    raw: dict[str, Any] = json.loads((CAPTURES / f"{name}.json").read_text())
    variable: dict[int, list[tuple[int, int]]] = {}
    for text in raw.get("variable", []):
        match = _RANGE.match(text)
        if match:
            step, start, end = map(int, match.groups())
            variable.setdefault(step, []).append((start, end))
    steps = [
        Step(
            index,
            item["from"],
            bytes.fromhex(item["hex"]),
            item.get("conn", 0),
            item.get("transport", ""),
            item.get("truncated_from", 0),
        )
        for index, item in enumerate(raw["steps"])
    ]
    ends = [(end["from"], end["after_step"]) for end in raw.get("ends") or []]
    return Capture(raw["name"], steps, variable, raw.get("ports") or {}, ends, raw["roles"])


@cache
def groups() -> dict[str, list[str]]:
    """Which captures belong together, as they were recorded."""
    found: dict[str, list[str]] = json.loads((CAPTURES / "groups.json").read_text())
    return found
