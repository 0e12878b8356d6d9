"""Findings about dialects: C++ YARP 4 spells numbers otherwise than all before it."""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import Finding


def find(case: Case) -> Iterator[Finding]:
    """two-dialects."""
    if not case.wanted:
        return
    spoken: dict[str, int] = {}
    for pair in case.pairs:
        if pair.carrier in ("text", "text_ack"):
            continue
        for name in (pair.source, pair.target):
            if name not in spoken:
                spoken[name] = case.dialect(name)
        reader, writer = case.port(pair.target), case.port(pair.source)
        if reader is not None and reader.ours:
            continue  # which reads both
        if writer is not None and writer.ours and pair.carrier != "mcast":
            continue  # which writes as its reader reads; a group may have readers of both
        source, target = spoken[pair.source], spoken[pair.target]
        if source and target and source != target:
            new = pair.source if source == 4 else pair.target
            old = pair.target if source == 4 else pair.source
            yield Finding(
                "two-dialects",
                pair.name,
                f'"{new}" is a port of YARP 4, "{old}" spells numbers as YARP 3 does: numbers with '
                "a decimal point mean something else to the other, so that lists break off or are "
                "misread",
                f"connect over text, which is the same in both: `yarpy connect {pair.source} "
                f"{pair.target} text`",
                "warning",
            )
