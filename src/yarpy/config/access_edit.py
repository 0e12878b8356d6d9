"""Changes to `access.toml` that a command makes: a right is given to somebody, or taken back.

Rules: the text of the file stays as its owner wrote it, comments included; a rule is added at its
end, or a rule that says only this is taken out. The result is read before it is written, and it is
written in one step, so programs that start meanwhile read the old file or the new one.
"""

from __future__ import annotations

import json
import os
import re
from contextlib import suppress
from pathlib import Path
from typing import Final

from yarpy.config.access import FILE, Access, Rule
from yarpy.config.access_file import parse
from yarpy.errors import AddressError
from yarpy.link.begin.admission import KNOWN, RUN, SCRIPT
from yarpy.platform.file_place import replace
from yarpy.platform.refusal import reason

_HEAD: Final = re.compile(r"\s*+\[")
_END: Final = ". No port opens until this is fixed"
_FIRST: Final = """\
# Everybody may do what YARP allows without this file. Take this rule out to keep strangers out.
[[allow]]
who = "anyone"
may = "all"
"""


def allow(where: Path, right: str, who: str) -> str:
    """Give `who` a right to all ports, in the file `where`, and return the line that says so.

    Without a file one is made, which allows all that is allowed without. Raises AddressError.
    """
    _check(right, who)
    text = _text(where)
    if text is None:
        if right not in (SCRIPT, RUN):
            raise AddressError(f"there is no {where}, so everybody may {right} already")
        text, made = _FIRST, " (a new file; everybody else keeps what they may do)"
    else:
        made = ""
        rules = _parsed(text, where).rules
        if any(who in rule.who and right in rule.may and not rule.ports for rule in rules):
            return f"{who} may {right} already: {where}"
    gap = "" if text.endswith("\n") or not text else "\n"
    quoted = json.dumps(who, ensure_ascii=False)
    fresh = f'{text}{gap}\n[[allow]]\nwho = {quoted}\nmay = "{right}"\n'
    _parsed(fresh, where)
    _write(where, fresh)
    return f"{who} may {right} from now on{made}: {where}. Programs read it when they start"


def refuse(where: Path, right: str, who: str) -> str:
    """Take out the rules that give `who` just this right, and return the line that says so.

    Raises AddressError, also where another rule gives the right together with something else.
    """
    _check(right, who)
    text = _text(where)
    rules = () if text is None else _parsed(text, where).rules
    giving = [rule for rule in rules if right in rule.may and who in rule.who]
    if text is None or not giving:
        if text is None and right not in (SCRIPT, RUN):
            raise AddressError(f"there is no {where}, so everybody may {right}: write one")
        return f"no rule lets {who} {right}: nothing to change in {where}"
    for rule in giving:
        if rule.who != (who,) or rule.may != {right}:
            line = f", line {rule.line}" if rule.line else ""
            raise AddressError(f"{where}{line}: this rule says more ({rule}): change it by hand")
    lines = text.splitlines(keepends=True)
    for rule in reversed(giving):
        lines = _without(lines, rule)
    fresh = "".join(lines)
    left = [(rule.who, rule.may, rule.ports) for rule in rules if rule not in giving]
    if [(rule.who, rule.may, rule.ports) for rule in _parsed(fresh, where).rules] != left:
        raise AddressError(f"{where} is written in a way that only its owner can change")
    _write(where, fresh)
    return f"{who} may no longer {right}: {where}. Programs read it when they start"


def _check(right: str, who: str) -> None:
    if right not in KNOWN:
        raise AddressError(f'there is no right "{right}"; the rights are {", ".join(KNOWN)}')
    if not who.isprintable():
        raise AddressError(f"{who!r} names nobody: it holds characters that cannot be printed")


def _text(where: Path) -> str | None:
    """Return the text of the file as it is, None without one. Raises AddressError."""
    try:
        with where.open(encoding="utf-8", newline="") as file:
            return file.read()
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, UnicodeDecodeError) as error:
        why = reason(error) if isinstance(error, OSError) else error
        raise AddressError(f"{where} cannot be read: {why}") from error


def _parsed(text: str, where: Path) -> Access:
    try:
        return parse(text, where)
    except AddressError as error:
        raise AddressError(f"nothing is changed: {str(error).removesuffix(_END)}") from None


def _without(lines: list[str], rule: Rule) -> list[str]:
    """Return the lines without those of a rule; comments in front of the next rule stay."""
    start = rule.line - 1
    if start < 0:
        return lines
    end = start + 1
    for at in range(end, len(lines)):
        if _HEAD.match(lines[at]):
            break
        if lines[at].strip() and not lines[at].lstrip().startswith("#"):
            end = at + 1
    if start and not lines[start - 1].strip():
        start -= 1
    return lines[:start] + lines[end:]


def _write(where: Path, text: str) -> None:
    """Replace the file in one step; it keeps its mode. Raises AddressError."""
    target = where.resolve()
    draft = target.with_name(f".{FILE}.{os.getpid()}")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with draft.open("x", encoding="utf-8", newline="") as file:
            if target.exists():
                draft.chmod(target.stat().st_mode & 0o7777)
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        replace(draft, target)
    except OSError as error:
        with suppress(OSError):
            draft.unlink()
        raise AddressError(f"{where} cannot be written: {error}") from error
