"""Writes what is derived from the code: the stub of the module, and the table in README.md.

    python compat/generate.py

tests/compat/test_generated.py fails while these are out of date.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
STUB = HERE / "src/yarp/__init__.pyi"
README = HERE / "README.md"
VERSIONS = ("3.9.1", "4.0.0")
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


def recorded(version: str) -> dict[str, list[str]]:
    """The public names of the bindings of a version of YARP, and the members of classes."""
    lines = (HERE / f"names-{version}.txt").read_text().splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    return {name: members for name, *members in rows}


def has(owner: Any, member: str) -> bool:
    """Return whether a class, or what it makes of nothing, has a member."""
    if hasattr(owner, member):
        return True
    try:
        return hasattr(owner(), member)
    except Exception:
        return False


def score(version: str) -> tuple[float, float, list[str]]:
    """The share of a version's names, of its members, and the names that are missing."""
    import yarp

    names = recorded(version)
    missing, there, count = [], 0, 0
    for name, members in names.items():
        count += len(members)
        try:
            found = getattr(yarp, name)
        except AttributeError:
            missing.append(name)
            continue
        there += sum(has(found, member) for member in members)
    return 1 - len(missing) / len(names), there / count, missing


def scores() -> list[str]:
    """The lines of README.md about them."""
    lines = ["Of all public names of the bindings, as SWIG makes them (`names-*.txt`):", ""]
    lines += ["| | names | members of classes |", "|---|---|---|"]
    absent: dict[str, None] = {}
    for version in VERSIONS:
        names, members, missing = score(version)
        lines.append(f"| YARP {version} | {names:.1%} | {members:.1%} |")
        absent |= dict.fromkeys(missing)
    lines += ["", f"Not here: {', '.join(f'`{name}`' for name in sorted(absent))}.", ""]
    return lines


def table() -> str:
    """The section of README.md."""
    from yarp._poly_driver import DEVICES
    from yarp._table import NOT_HERE, WHERE

    names, uses, missing = coverage()
    lines = [
        f"Of the {len(ranked())} names that stand in public programs most often (`ranked.txt`),",
        f"{names:.1%} are here, and {uses:.1%} of the times that they are used.",
        *([f"Not here: {', '.join(f'`{name}`' for name in missing)}."] if missing else []),
        "",
        *scores(),
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
