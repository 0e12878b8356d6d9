"""Writes what is derived from the code: the stub of the module, and the table in README.md.

    python compat/generate.py

tests/compat/test_generated.py fails while these are out of date.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, NamedTuple

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
    for name in (
        "YARP_VERSION_MAJOR",
        "YARP_VERSION_MINOR",
        "YARP_VERSION_PATCH",
        "YARP_VERSION_HEX",
    ):
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


def find(owner: Any, member: str) -> Any:
    """Return a member of a class, or of what it makes of nothing; None if there is none."""
    found = getattr(owner, member, None)
    if found is not None or hasattr(owner, member):
        return owner if found is None else found
    try:
        made = owner()
        return getattr(made, member) if hasattr(made, member) else None
    except Exception:
        return None


class Score(NamedTuple):
    """Of a version's names: shares that can be imported, of members that are there, and of members
    that do something; the names that are missing, and what refuses to be called."""

    names: float
    members: float
    working: float
    missing: list[str]
    refusing: list[str]


def score(version: str) -> Score:
    """Return the score of a version."""
    import yarp
    from yarp._refusal import refused

    names = recorded(version)
    missing: list[str] = []
    refusing: list[str] = []
    there = count = 0
    for name, members in names.items():
        count += len(members)
        try:
            owner = getattr(yarp, name)
        except AttributeError:
            missing.append(name)
            continue
        for member in members:
            found = find(owner, member)
            there += found is not None
            if found is not None and refused(found):
                refusing.append(f"{name}.{member}")
    return Score(
        1 - len(missing) / len(names),
        there / count,
        (there - len(refusing)) / count,
        missing,
        refusing,
    )


def percent(share: float) -> str:
    """Return a share as text; 100% is all of it.

    >>> percent(0.9999), percent(1.0)
    ('99.9%', '100.0%')
    """
    return f"{int(share * 1000) / 10:.1f}%"


def scores() -> list[str]:
    """The lines of README.md about them."""
    lines = [
        "Of all public names of the bindings, as SWIG makes them (`names-*.txt`), and of the",
        "members of their classes; some refuse when they are called and say why, as they mean",
        "nothing in Python:",
        "",
        "| | names | members | members that do not refuse |",
        "|---|---|---|---|",
    ]
    absent: dict[str, None] = {}
    refusing: dict[str, list[str]] = {}
    for version in VERSIONS:
        found = score(version)
        shares = (found.names, found.members, found.working)
        lines.append(f"| YARP {version} | {' | '.join(map(percent, shares))} |")
        absent |= dict.fromkeys(found.missing)
        for each in found.refusing:
            owner, _, member = each.partition(".")
            owners = refusing.setdefault(member, [])
            if owner not in owners:
                owners.append(owner)
    if absent:
        lines += ["", f"Not here: {', '.join(f'`{name}`' for name in sorted(absent))}."]
    grouped: dict[str, list[str]] = {}
    for member, owners in sorted(refusing.items()):
        grouped.setdefault(" ".join(f"`{each}`" for each in sorted(owners)), []).append(member)
    lines += ["", "| class | refuses |", "|---|---|"]
    for kinds, each in grouped.items():
        lines.append(f"| {kinds} | {' '.join(f'`{name}`' for name in each)} |")
    return [*lines, ""]


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
    lines += ["", "| refuses | why |", "|---|---|"]
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
