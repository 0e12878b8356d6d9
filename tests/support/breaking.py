"""Which programs would break that were written for the last release: `make check` asks.

    python tests/support/breaking.py         beside the newest tag of a release, as v1.2.0
    python tests/support/breaking.py REF     beside any commit

Rules: only names count that the modules below list in `__all__`, with the public members of their
classes; where they are defined may change. The exit code is 1 if something would break: it is then
mended, or told in CHANGELOG.md and named in ALLOWED until the next release.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import griffe

ROOT: Final = Path(__file__).parents[2]
PUBLIC: Final = ("", "aio", "clock", "idl", "kits.thrift", "kits.wrap", "kits.record", "testing")
ALLOWED: Final[frozenset[str]] = frozenset()  # such as "Port.write(timeout)"


def last_release(root: Path) -> str:
    """Return the newest tag of a release that a checkout comes from, "" if there was none."""
    said = subprocess.run(
        ["git", "describe", "--tags", "--abbrev=0", "--match", "v[0-9]*"],
        cwd=root,
        capture_output=True,
        text=True,
    )
    return said.stdout.strip()


def public(package: Any, module: str) -> dict[str, Any]:
    """Return what a module of a package lists, by name, as it is defined."""
    try:
        whole = package[module] if module else package
    except KeyError:
        return {}
    found = {}
    for name in whole.exports or ():
        one = whole.members.get(str(name))
        try:
            found[str(name)] = one.final_target if one is not None and one.is_alias else one
        except griffe.AliasResolutionError:
            pass  # of another package
    return {name: one for name, one in found.items() if one is not None}


def broken(root: Path, package: str, release: str) -> Iterator[tuple[str, str]]:
    """Return what a program for `release` would miss, and why."""
    before = griffe.load_git(package, ref=release, repo=root, search_paths=["src"])
    after = griffe.load(package, search_paths=[root / "src"])
    for module in PUBLIC:
        old, new = public(before, module), public(after, module)
        for name, was in old.items():
            label, now = f"{module}.{name}".lstrip("."), new.get(name)
            if now is None:
                yield label, "it is gone"
                continue
            for one in griffe.find_breaking_changes(_holder(name, was), _holder(name, now)):
                about = one.obj.path.replace(was.path, label, 1).replace(now.path, label, 1)
                parameter = getattr(one.old_value, "name", "") if one.obj.is_function else ""
                yield f"{about}({parameter})" if parameter else about, one.kind.value


def _holder(name: str, one: Any) -> Any:
    """Return a module that has nothing but this. It stays where its bases are found."""
    holder = griffe.Module("public")
    holder.exports = {name}
    holder.members[name] = one
    return holder


def main(words: list[str]) -> int:
    release = words[0] if words else last_release(ROOT)
    if not release:
        print("nothing was released yet: no program can break")
        return 0
    found = dict(broken(ROOT, "yarpy", release))
    wrong = {what: why for what, why in found.items() if what not in ALLOWED}
    for what, why in sorted(wrong.items()):
        print(f"{what}: {why}, since {release}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
