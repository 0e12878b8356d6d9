"""`access.toml`: who may do what with the ports of this computer.

    [[allow]]                               # as many of these as you like
    who = ["192.168.1.0/24", "tls:operator", "token:panel"]
    may = ["read", "write"]                 # administer, attach, register; or "all"; script apart
    ports = ["/icubSim/*"]                  # without: all ports

    [tokens]                                # for web pages: http://HOST:PORT/?token=...
    panel = "4Zr2kXqyJtWm0v8N"              # or {file = "panel.token"}, beside this file
    arm = {curve = "f81c..."}               # the public key of a ZeroMQ socket that dials

Rules: the file lies beside yarp.conf, or where YARPY_ACCESS says. It is read once, when the program
opens its first port; with a mistake in it no port opens. Without it everything is allowed, as in
C++ YARP.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from yarpy.config.access import ALL, FILE, Access, Rule, RuledGate
from yarpy.errors import AddressError
from yarpy.link.begin.admission import KNOWN, RIGHTS, Gate
from yarpy.platform.folders import conf_directory, folder
from yarpy.platform.refusal import reason

SETTING: Final = "YARPY_ACCESS"
LEAST: Final = 16  # characters of a token

_WHO: Final = (
    'an address ("192.168.1.7"), a range ("192.168.1.0/24"), "loopback" (this computer), "anyone", '
    '"tls:NAME", "key" or "token:NAME"'
)
_TOKEN: Final = re.compile(r"[A-Za-z0-9_.~-]+")
_KEY: Final = re.compile(r"[0-9a-fA-F]{64}")
_HEAD: Final = re.compile(r"\s*+\[\[\s*+allow\s*+\]\]")


def gate(port: str, names: bool = False) -> Gate:
    """The gate of the port called `port`. Raises AddressError for a file with a mistake in it."""
    access = current()
    return Gate() if access is None else RuledGate(access, port, names)


def current() -> Access | None:
    """The rules of this process, None without a file. Raises AddressError."""
    return _loaded(path(os.environ), bool(os.environ.get(SETTING)))


def path(environment: Mapping[str, str]) -> Path:
    """Return the path of the file, whether it exists or not."""
    said = environment.get(SETTING)
    return Path(said).absolute() if said else folder(str(conf_directory(environment)), FILE)


@lru_cache(maxsize=8)
def _loaded(where: Path, named: bool) -> Access | None:
    """The rules in a file, which is read once. `named`: it has to be there."""
    try:
        where.stat()
    except (FileNotFoundError, NotADirectoryError):
        if not named:
            return None
    except OSError:
        pass  # it may be there: reading says what is wrong
    return load(where)


def load(where: Path) -> Access:
    """Read a file. Raises AddressError, which says where the mistake is and what may be there."""
    try:
        text = where.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise AddressError(f"{where} cannot be read, so no port opens: {error}") from error
    return parse(text, where)


def parse(text: str, where: Path | str = FILE) -> Access:
    """The rules that a text contains; files of tokens are beside `where`. Raises AddressError."""
    import tomllib

    reader = _Reader(text, Path(where))
    try:
        told = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise reader.mistake(0, f"this is not TOML: {error}") from None
    reader.check_keys(told, ("allow", "tokens"), 0, "")
    tokens, keys = reader.tokens(told.get("tokens", {}))
    rules = told.get("allow", [])
    if not isinstance(rules, list) or not all(isinstance(rule, dict) for rule in rules):
        raise reader.mistake(reader.line("allow"), "write each rule below a line [[allow]]")
    found = tuple(reader.rule(number, rule) for number, rule in enumerate(rules))
    for rule in found:
        for one in rule.who:
            if one.startswith("token:") and one[6:] not in {*tokens, *keys}:
                known = ", ".join((*tokens, *keys)) or "none"
                raise reader.mistake(
                    reader.line(one, rule.line),
                    f'who: "{one}" has no secret: [tokens] needs a line {one[6:]} = "..." '
                    f"(there: {known})",
                )
    return Access(found, tokens, str(where), keys)


class _Reader:
    """Reads the parts of a file, and finds the lines of mistakes."""

    def __init__(self, text: str, path: Path) -> None:
        self._lines = text.splitlines()
        self._path = path

    def line(self, word: str, start: int = 0) -> int:
        """The number of the first line from `start` on that contains a word; `start` without."""
        for number, line in enumerate(self._lines[max(start - 1, 0) :], max(start, 1)):
            if word in line.partition("#")[0]:
                return number
        return start

    def mistake(self, line: int, text: str) -> AddressError:
        at = f", line {line}" if line else ""
        return AddressError(f"{self._path}{at}: {text}. No port opens until this is fixed")

    def check_keys(
        self, table: Mapping[str, Any], known: tuple[str, ...], start: int, where: str
    ) -> None:
        for key in table:
            if key not in known:
                raise self.mistake(
                    self.line(key, start),
                    f'"{key}" has no meaning here{where}{_meant(key, known)}; '
                    f"this may hold {', '.join(known)}",
                )

    def rule(self, number: int, table: Mapping[str, Any]) -> Rule:
        heads = (at for at, line in enumerate(self._lines, 1) if _HEAD.match(line))
        start = next((at for index, at in enumerate(heads) if index == number), 0)
        self.check_keys(table, ("who", "may", "ports"), start, " below [[allow]]")
        for key in ("who", "may"):
            if key not in table:
                raise self.mistake(start, f"[[allow]] needs a line {key} = [...]")
        who = self._words(table, "who", start)
        for one in who:
            self._check_who(one, start)
        may: set[str] = set()
        for right in self._words(table, "may", start):
            if right == ALL:
                may |= {*RIGHTS}
            elif right in KNOWN:
                may.add(right)
            else:
                known = (*KNOWN, ALL)
                raise self.mistake(
                    self.line(f'"{right}"', start),
                    f'may: there is no right "{right}"{_meant(right, known)}; '
                    f"the rights are {', '.join(known)}",
                )
        ports = self._words(table, "ports", start) if "ports" in table else ()
        for one in ports:
            if not one.startswith(("/", "*")):
                raise self.mistake(
                    self.line(f'"{one}"', start),
                    f'ports: "{one}" is not the name of a port: names begin with "/", and a * '
                    'stands for any text, as in "/icubSim/*"',
                )
        return Rule(who, frozenset(may), ports, start)

    def _words(self, table: Mapping[str, Any], key: str, start: int) -> tuple[str, ...]:
        value = table[key]
        words = [value] if isinstance(value, str) else value
        if not (isinstance(words, list) and words and all(isinstance(w, str) for w in words)):
            raise self.mistake(
                self.line(key, start), f'{key}: write texts in brackets, ["...", ...]'
            )
        return tuple(words)

    def _check_who(self, one: str, start: int) -> None:
        kind, colon, name = one.partition(":")
        if one in ("loopback", "anyone", "key") or (colon and name and kind in ("tls", "token")):
            return
        from ipaddress import ip_network

        line = self.line(f'"{one}"', start)
        try:
            ip_network(one)
        except ValueError:
            pass
        else:
            return
        try:
            meant = ip_network(one, strict=False)
        except ValueError:
            raise self.mistake(line, f'who: "{one}" names nobody: write {_WHO}') from None
        own = one.partition("/")[0]
        raise self.mistake(
            line, f'who: "{one}" is both one computer and a range: write "{own}" or "{meant}"'
        )

    def tokens(self, table: Any) -> tuple[dict[str, str], dict[str, str]]:
        """The secrets, and the public keys, by their names."""
        if not isinstance(table, dict):
            raise self.mistake(
                self.line("tokens"), 'tokens: write [tokens], and below it NAME = "..."'
            )
        start = self.line("[tokens]")
        secrets, keys = {}, {}
        for name, value in table.items():
            line = self.line(name, start)
            if isinstance(value, dict) and "curve" in value:
                keys[name] = self._key(name, value, line)
            else:
                secrets[name] = self._token(name, value, line)
        return secrets, keys

    def _key(self, name: str, value: dict[str, Any], line: int) -> str:
        key = value["curve"]
        if len(value) > 1 or not isinstance(key, str) or not _KEY.fullmatch(key):
            raise self.mistake(
                line,
                f'tokens: write {name} = {{curve = "..."}} with the 64 hexadecimal digits of a '
                "public key: zmq.utils.z85.decode(key).hex() makes them of one in Z85",
            )
        return key.lower()

    def _token(self, name: str, value: Any, line: int) -> str:
        from secrets import token_urlsafe

        if isinstance(value, dict) and isinstance(value.get("file"), str) and len(value) == 1:
            file = self._path.parent / value["file"]
            try:
                value = file.read_text("utf-8").strip()
            except (OSError, UnicodeDecodeError) as error:
                why = reason(error) if isinstance(error, OSError) else error
                raise self.mistake(line, f"tokens: {file} cannot be read: {why}") from error
        if not isinstance(value, str):
            raise self.mistake(line, f'tokens: write {name} = "..." or {name} = {{file = "..."}}')
        if len(value) < LEAST or not _TOKEN.fullmatch(value):
            raise self.mistake(
                line,
                f"tokens: {name} needs at least {LEAST} letters, digits, - or _, such as "
                f'{name} = "{token_urlsafe(16)}"',
            )
        return value


def _meant(word: str, known: tuple[str, ...]) -> str:
    from difflib import get_close_matches

    near = get_close_matches(word.lower(), known, n=1)
    return f' (did you mean "{near[0]}"?)' if near else ""
