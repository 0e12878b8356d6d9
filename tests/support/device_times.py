"""The tables of docs/devices.md that say how long calls take between C++ YARP and yarpy.

They are made from `bench/device_peers.json`, which `python bench/device_peers.py --write` measured;
`device_table.py` puts them on the page.

Rules: what was not measured with a version is a dash.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Final

KEPT: Final = Path(__file__).parents[2] / "bench" / "device_peers.json"
PAIRS: Final = ("C++ to C++", "C++ to yarpy", "yarpy to C++")
#: Whose two halves C++ YARP does not have.
WITHOUT: Final = {
    "IAudioRender": "C++ has no client of it",
    "ICartesianControl": "both halves are of icub-main",
    "IFrameWriterImage": "C++ has no client of it",
    "IGazeControl": "both halves are of icub-main",
    "IVirtualAnalogSensor": "C++ has no client of it",
}


def tables() -> str:
    """What was measured, then a table of calls and one of streams."""
    kept: dict[str, Any] = json.loads(KEPT.read_text(encoding="utf-8"))
    lines = [
        f"C++ {version}: {each['date']}, {each['machine']}, CPython {each['python']}, "
        f"{_rounds(each['rounds'])}, {each['calls']} calls each.  "
        for version, each in kept.items()
    ]
    lines += ["", *_table(kept, "call", _call), "", *_table(kept, "age", _stream)]
    return "\n".join(lines) + "\n"


def _rounds(count: int) -> str:
    return f"the least disturbed of {count} rounds" if count > 1 else "one round"


def _table(kept: dict[str, Any], figure: str, cell: Any) -> list[str]:
    rows: dict[str, dict[str, Any]] = {}
    for version, each in kept.items():
        for interface, row in each["rows"].items():
            if any(figure in row[pair] for pair in PAIRS):
                asked = f"`{interface}`, `{row['function']}`"
                name = asked if figure == "call" else f"`{row['streams']}`"
                rows.setdefault(name, {})[version] = row
    heads = [f"{version}: {pair}" for version in kept for pair in PAIRS]
    title = "a call of" if figure == "call" else "values of"
    lines = [f"| {title} | {' | '.join(heads)} |", "|---" * (len(heads) + 1) + "|"]
    for name in sorted(rows):
        cells = [
            cell(rows[name].get(version, {}).get(pair, {})) for version in kept for pair in PAIRS
        ]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    if figure == "call":
        last = " |" * (len(heads) - 1)
        lines += [f"| `{name}` | {why} |{last}" for name, why in WITHOUT.items()]
    return lines


def _call(figures: dict[str, float]) -> str:
    return f"{figures['call']:.0f} µs" if "call" in figures else "-"


def _stream(figures: dict[str, float]) -> str:
    if "age" not in figures:
        return "-"
    return f"{figures['rate']:.0f} Hz, {figures['age'] / 1000:.1f} ms"
