"""Writes what is derived from the code: the stub of the module, and the table in README.md.

    python compat/generate.py

tests/compat/test_generated.py fails while these are out of date.
"""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).parent
STUB = HERE / "src/yarp/__init__.pyi"
README = HERE / "README.md"
BEGIN, END = "<!-- generated: table -->\n", "<!-- end -->\n"


def stub() -> str:
    """The names of the module, for type checkers."""
    import yarp
    from yarp._constants import CONSTANTS
    from yarp._table import WHERE

    lines = ['"""Written by generate.py: the names of `yarp`, for type checkers."""', ""]
    for module in sorted(set(WHERE.values())):
        names = sorted(name for name, where in WHERE.items() if where == module)
        for name in names:
            lines.append(f"from yarp.{module} import {name} as {name}")
    lines.append("")
    for name in ("YARP_VERSION", "YARP_VERSION_SHORT"):
        lines.append(f"{name}: str")
    for name in ("YARP_VERSION_MAJOR", "YARP_VERSION_MINOR", "YARP_VERSION_PATCH"):
        lines.append(f"{name}: int")
    lines += [f"{name}: int" for name in sorted(CONSTANTS)]
    lines.append("")
    for name in sorted(WHERE):
        kind = getattr(yarp, name)
        if not isinstance(kind, type):
            continue
        found: set[str] = set()
        for base in kind.__mro__:
            for member, value in vars(base).items():
                if isinstance(value, staticmethod) and not member.startswith("_"):
                    found.add(member)
        lines += [f"{name}_{member} = {name}.{member}" for member in sorted(found)]
    return "".join(f"{line}\n" for line in lines)


def ranked() -> list[tuple[str, int]]:
    """Names and in how many public files each is used."""
    rows = []
    for line in (HERE / "ranked.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            name, count = line.split()
            rows.append((name, int(count)))
    return rows


def is_there(name: str) -> bool:
    """Return whether compat has a name, or a method of a class."""
    import yarp

    owner, _, member = name.partition(".")
    try:
        found = getattr(yarp, owner)
    except AttributeError:
        return False
    return not member or hasattr(found, member)


def coverage() -> tuple[float, float, list[str]]:
    """The share of the ranked names, that of their uses, and the names that are missing."""
    rows = ranked()
    there = [(name, count) for name, count in rows if is_there(name)]
    missing = [name for name, count in rows if not is_there(name)]
    uses = sum(count for _, count in there) / sum(count for _, count in rows)
    return len(there) / len(rows), uses, missing


def table() -> str:
    """The section of README.md."""
    from yarp._poly_driver import DEVICES
    from yarp._table import NOT_HERE, WHERE

    names, uses, missing = coverage()
    lines = [
        f"Of the {len(ranked())} names that stand in public programs most often (`ranked.txt`),",
        f"{names:.1%} are here, and {uses:.1%} of the times that they are used. Not here:",
        f"{', '.join(f'`{name}`' for name in missing)}.",
        "",
        "| | |",
        "|---|---|",
    ]
    groups: dict[str, list[str]] = {}
    for name, module in WHERE.items():
        groups.setdefault(module.strip("_").replace("_", " "), []).append(f"`{name}`")
    lines += [f"| {group} | {' '.join(found)} |" for group, found in groups.items()]
    lines.append(
        f"| devices for PolyDriver | {' '.join(f'`{name}`' for name in sorted(DEVICES))} |"
    )
    lines += ["", "| not here | why |", "|---|---|"]
    lines += [f"| `{name}` | {why} |" for name, why in NOT_HERE.items()]
    return "".join(f"{line}\n" for line in lines)


def readme() -> str:
    """README.md with a fresh table."""
    text = README.read_text()
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    return head + BEGIN + table() + END + tail


if __name__ == "__main__":
    sys.path.insert(0, str(HERE / "src"))
    STUB.write_text(stub())
    README.write_text(readme())
    print(f"{coverage()[0]:.1%} of the names, {coverage()[1]:.1%} of their uses")
