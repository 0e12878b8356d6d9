"""Finding: one thing that the doctor found, what it means, and what to do about it.

A family of findings is a function that takes a Case and yields Findings. It is found by name in the
entry point group `yarpy.findings`, so a package may add its own:

    def cables(case: Case) -> Iterator[Finding]:
        for pair in case.pairs:
            if ...:
                yield Finding("loose-cable", pair.name, "the cable is loose", "push it in")

Rules: a family asks nothing that changes anything, and nothing without a time limit; most only look
at what the Case has gathered. Verdicts are sentences without a capital and a full stop; they may
contain what strangers say, so whoever shows them makes them readable.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

#: `fault`: messages do not arrive because of it; `warning`: they may not; `note`: good to know
Level: TypeAlias = Literal["fault", "warning", "note"]

LEVELS: Final[tuple[Level, ...]] = ("fault", "warning", "note")


@dataclass(frozen=True, slots=True)
class Finding:
    """`probe` is the name of the kind of finding (`never-reads`), `about` what it is about (a port,
    `/a -> /b`, a server, this computer), `advice` what mends it, commands in backticks."""

    probe: str
    about: str
    verdict: str
    advice: str = ""
    level: Level = "fault"
