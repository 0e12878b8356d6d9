"""The rules of `yarpy autoqos`: what matters, and what the others keep.

    [[critical]]
    connections = ["/icub/*/command:i", "/control -> /motors"]
    deadline = 0.01             # seconds a message may take
    rate = 100                  # messages per second, needed where messages have no stamp

    [[best-effort]]
    connections = ["/icub/cam/*"]
    least = 2.0                 # Mbit/s that each connection keeps in any case
    carrier = "tcp+send.adaptive+recv.image_compression_jpeg"   # that it may be moved to

Rules: a pattern is the name of either port, or of both with `->` between; `*`, `?` and `[]` are
wildcards. Of several rules of one kind the first that matches counts. A mistake is a
LocalProtocolError with file and line.
"""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

from yarpy.errors import LocalProtocolError
from yarpy.platform.refusal import reason
from yarpy.route import parse_carrier

Kind: TypeAlias = Literal["critical", "best-effort"]

MOST: Final = 1000  # patterns
_KEYS: Final[dict[str, tuple[str, ...]]] = {
    "critical": ("connections", "deadline", "rate"),
    "best-effort": ("connections", "least", "carrier"),
}
_RANGES: Final = {"deadline": (1e-4, 3600.0), "rate": (0.01, 1e5), "least": (0.0, 1e6)}


@dataclass(frozen=True, slots=True)
class Rule:
    """One table of the file, at `line`. `deadline` in seconds, `rate` in messages per second (0:
    unknown), `least` in Mbit/s, `carrier` "" for none."""

    kind: Kind
    connections: tuple[str, ...]
    deadline: float = 0.0
    rate: float = 0.0
    least: float = 0.0
    carrier: str = ""
    line: int = 0

    def matches(self, source: str, target: str) -> bool:
        """Return whether the rule is about the connection `source` -> `target`."""
        return any(_matches(pattern, source, target) for pattern in self.connections)


@dataclass(frozen=True, slots=True)
class Rules:
    """All of them, in the order of the file; `where` they were read."""

    rules: tuple[Rule, ...]
    where: str = ""

    def of(self, source: str, target: str) -> list[Rule]:
        """The first rule of each kind that matches: none, one, or two that contradict each
        other."""
        found: dict[Kind, Rule] = {}
        for rule in self.rules:
            if rule.kind not in found and rule.matches(source, target):
                found[rule.kind] = rule
        return list(found.values())


def _matches(pattern: str, source: str, target: str) -> bool:
    left, arrow, right = (part.strip() for part in pattern.partition("->"))
    if arrow:
        return fnmatchcase(source, left) and fnmatchcase(target, right)
    return fnmatchcase(source, left) or fnmatchcase(target, left)


def load(path: Path) -> Rules:
    """Read a file. Raises LocalProtocolError."""
    try:
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        why = reason(error) if isinstance(error, OSError) else error
        raise LocalProtocolError(f"{path} cannot be read: {why}") from error
    return parse(text, str(path))


def parse(text: str, where: str = "rules") -> Rules:
    """The rules in a text. Raises LocalProtocolError with the line of the mistake."""
    try:
        told = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise LocalProtocolError(f"{where}: this is not TOML: {error}") from error
    heads = _heads(text)
    unknown = [key for key in told if key not in _KEYS]
    if unknown:
        line = next((n for n, key in heads if key == unknown[0]), _line(text, unknown[0]))
        raise _mistake(where, line, f'"{unknown[0]}": expected [[critical]] or [[best-effort]]')
    rules: list[Rule] = []
    for kind in _KEYS:
        tables = told.get(kind, [])
        if not isinstance(tables, list) or not all(isinstance(one, dict) for one in tables):
            raise _mistake(where, _line(text, kind), f"expected tables, each below [[{kind}]]")
        lines = [number for number, key in heads if key == kind]
        lines += [0] * (len(tables) - len(lines))
        rules += [
            _Table(text, where, kind, number).rule(table)
            for table, number in zip(tables, lines, strict=False)
        ]
    if not rules:
        raise _mistake(where, 1, "expected at least one table [[critical]] or [[best-effort]]")
    rules.sort(key=lambda rule: rule.line)
    if sum(len(rule.connections) for rule in rules) > MOST:
        raise _mistake(where, 1, f"expected at most {MOST} patterns")
    _check_contradictions(rules, where)
    return Rules(tuple(rules), where)


def _check_contradictions(rules: list[Rule], where: str) -> None:
    """Refuse what is certain before any port is known."""
    seen: dict[str, Rule] = {}
    for rule in rules:
        for pattern in rule.connections:
            first = seen.setdefault(" ".join(pattern.split()), rule)
            if first is not rule:
                raise _mistake(
                    where, rule.line,
                    f'"{pattern}" stands in line {first.line} already, as {first.kind}; expected '
                    "each pattern once",
                )  # fmt: skip


class _Table:
    """One table, and where it stands."""

    def __init__(self, text: str, where: str, kind: str, line: int) -> None:
        self._text, self._where, self._kind, self._line = text, where, kind, line

    def rule(self, table: dict[str, Any]) -> Rule:
        known = _KEYS[self._kind]
        for key in table:
            if key not in known:
                raise self._wrong(key, f'"{key}": expected {", ".join(known)}')
        numbers = {key: self._number(key, table[key]) for key in table if key in _RANGES}
        if self._kind == "critical" and "deadline" not in numbers:
            raise self._wrong("", "expected a deadline in seconds, such as deadline = 0.02")
        kind: Kind = "critical" if self._kind == "critical" else "best-effort"
        patterns = self._patterns(table.get("connections"))
        carrier = self._carrier(table.get("carrier", ""))
        return Rule(kind, patterns, **numbers, carrier=carrier, line=self._line)

    def _patterns(self, told: Any) -> tuple[str, ...]:
        expected = 'expected a list of patterns, such as connections = ["/cam/*", "/a -> /b"]'
        if not (isinstance(told, list) and told and all(isinstance(one, str) for one in told)):
            raise self._wrong("connections", expected)
        for pattern in told:
            parts = [part.strip() for part in pattern.split("->")]
            good = len(parts) <= 2 and all(re.match(r"[/*?\[]", part) for part in parts)
            if not good or any(c.isspace() for part in parts for c in part):
                raise self._wrong(pattern, f'"{pattern}" is no pattern: {expected}')
        return tuple(told)

    def _number(self, key: str, told: Any) -> float:
        least, most = _RANGES[key]
        if (
            isinstance(told, bool)
            or not isinstance(told, int | float)
            or not (math.isfinite(told) and least <= told <= most)
        ):
            raise self._wrong(key, f"{key} = {told!r:.40}: expected a number {least:g} to {most:g}")
        return float(told)

    def _carrier(self, told: Any) -> str:
        if not isinstance(told, str):
            raise self._wrong("carrier", f"carrier = {told!r:.40}: expected a text in quotes")
        if told and not re.fullmatch(r"[a-z_0-9]++(\+[^\s]++)?", str(parse_carrier(told))):
            raise self._wrong("carrier", f'carrier = "{told:.40}": expected one such as "fast_tcp"')
        return told

    def _wrong(self, word: str, what: str) -> LocalProtocolError:
        line = _line(self._text, word, self._line) if word else self._line
        return _mistake(self._where, line, what)


def _mistake(where: str, line: int, what: str) -> LocalProtocolError:
    return LocalProtocolError(f"{where}, line {max(line, 1)}: {what}")


def _heads(text: str) -> list[tuple[int, str]]:
    """The lines where tables begin, and their names."""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        words = line.strip().partition("#")[0].strip()
        if words.startswith("["):
            found.append((number, words.strip("[] \"'")))
    return found


def _line(text: str, word: str, start: int = 1) -> int:
    """The first line from `start` on that has the word."""
    for number, line in enumerate(text.splitlines(), 1):
        if number >= start and word in line:
            return number
    return start
