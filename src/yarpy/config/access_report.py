"""The rules of access in words: all of them, or why somebody may do something, or not.

Rules: lines of at most 79 characters where names are short; nothing is printed here.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from ipaddress import ip_address
from pathlib import Path
from textwrap import wrap
from typing import Final

from yarpy.config.access import FILE, Access, Rule
from yarpy.errors import AddressError
from yarpy.link.begin.admission import KNOWN, RIGHTS, RUN, SCRIPT, Peer, same_computer

WIDTH: Final = 79

_DEFAULTS: Final = """\
Without it, as with C++ YARP, whoever reaches a port may
  read        what it writes
  write       messages to it; web pages of other origins may not
              (YARPY_WEB_ORIGINS)
  administer  it: connect, disconnect, priorities; such web pages may not
  attach      monitors that are installed; scripts where YARPY_SCRIPTS says so
  register    names, with a name server
YARPY_BIND says from where a port is reached: now {reach}."""


def defaults(where: Path, reach: str) -> list[str]:
    """Return the lines that say what is allowed without a file. where: its place. reach: who
    reaches ports here."""
    head = wrap(f"There is no {FILE}; it would be {where}.", WIDTH, break_long_words=False)
    return [*head, *_DEFAULTS.format(reach=reach).splitlines()]


def listing(access: Access) -> list[str]:
    """Every rule, and what else there is to know of them."""
    lines = [f"The rules of {access.path}:"]
    for number, rule in enumerate(access.rules, 1):
        lines.append("")
        lines += _wrapped(f"{number}. ", ", ".join(rule.who))
        whole = rule.may >= frozenset(RIGHTS)
        rest = [right for right in _sorted(rule) if right not in RIGHTS]
        rights = ", ".join(["everything", *rest] if whole else _sorted(rule))
        lines += _wrapped("   may ", rights)
        lines += _wrapped("   ports ", ", ".join(rule.ports) or "all")
    lines += ["", "What no rule allows is refused. Programs read the file when they start."]
    if access.tokens:
        lines += _wrapped("Web tokens: ", ", ".join(access.tokens))
    if access.keys:
        lines += _wrapped("Public keys: ", ", ".join(access.keys))
    return lines


def notes(access: Access, *, authority: Path, has_key: bool) -> Iterator[str]:
    """Yield what may be missing for the rules to have their intended effect. authority: where the
    certificate is that others are checked against. has_key: there is an auth.conf."""
    named = {one for rule in access.rules for one in rule.who}
    if not named & {"loopback", "anyone"} and not any(one.startswith("127.") for one in named):
        yield (
            'no rule is about "loopback": the programs of this computer may do nothing with each '
            "other's ports"
        )
    if any(one.startswith("tls:") for one in named) and not authority.is_file():
        yield f"nobody can be known as tls:NAME without {authority} (yarpy cert makes it)"
    if "key" in named and not has_key:
        yield "nobody can prove a key without auth.conf"
    unused = [name for name in (*access.tokens, *access.keys) if f"token:{name}" not in named]
    if unused:
        yield f"no rule is about the token {', '.join(unused)}"
    file = Path(access.path)
    bits = 0o077 if sys.platform != "win32" else 0  # there a file has no bits for others
    if access.tokens and file.is_file() and file.stat().st_mode & bits:
        yield f"others on this computer can read its tokens: chmod 600 {file}"


def peer_from(text: str, access: Access | None) -> Peer:
    """Somebody, as he is written in a rule; several facts with commas: `10.0.0.1,tls:operator`.

    Raises AddressError.
    """
    address, here, names, key, token = "", False, [], False, ""
    for fact in text.split(","):
        kind, _, name = fact.partition(":")
        if fact == "loopback":
            address, here = "127.0.0.1", True
        elif fact == "key":
            key = True
        elif kind == "tls" and name:
            names.append(name)
        elif kind == "token" and name:
            token = name
            if access is not None and name not in {*access.tokens, *access.keys}:
                known = ", ".join((*access.tokens, *access.keys)) or "there is none"
                raise AddressError(f'no web token is called "{name}" in {access.path}: {known}')
        else:
            try:
                address = str(ip_address(fact))
            except ValueError:
                raise AddressError(
                    f'"{fact}" names nobody: write an address (192.168.1.9), loopback, tls:NAME, '
                    "key or token:NAME, several with commas"
                ) from None
            here = same_computer(address, "")
    return Peer(address, here, tuple(names), key, token)


def explained(access: Access | None, who: str, right: str, port: str) -> tuple[bool, list[str]]:
    """Return whether a peer may do that with a port, and which rule says so or comes near.

    access: None without a file. Raises AddressError for what cannot be meant.
    """
    if right not in KNOWN:
        raise AddressError(f'there is no right "{right}"; the rights are {", ".join(KNOWN)}')
    if not port.startswith("/"):
        raise AddressError(f'"{port}" is not the name of a port: names begin with "/"')
    peer = peer_from(who, access)
    if access is None and right == SCRIPT:
        text = f"there is no {FILE}, so scripts run where YARPY_SCRIPTS says so"
        return False, _wrapped("no: ", text)
    if access is None and right == RUN:
        text = f"there is no {FILE}, so programs are started for their owner here alone"
        return False, _wrapped("no: ", text)
    if access is None:
        limits = {"attach": " (scripts where YARPY_SCRIPTS says so)"}.get(right, "")
        text = f"there is no {FILE}, so whoever reaches {port} may {right}{limits}"
        return True, _wrapped("yes: ", text)
    found = access.rule_for(peer, right, port)
    if found is not None:
        return True, _wrapped("yes: ", f"{_number(access, found)}: {found}")
    lines = _wrapped("no: ", f"no rule lets {who} {right} {port}")
    for rule in access.rules:
        if rule.meets(peer):
            lacking = [] if right in rule.may else [f"lets them only {', '.join(_sorted(rule))}"]
            if not rule.covers(port):
                lacking.append(f"is for {', '.join(rule.ports)}")
            lines += _wrapped("    ", f"{_number(access, rule)} names them, but {_and(lacking)}")
        elif right in rule.may and rule.covers(port):
            lines += _wrapped("    ", f"{_number(access, rule)} lets others: {', '.join(rule.who)}")
    return False, lines


def _number(access: Access, rule: Rule) -> str:
    at = f" (line {rule.line})" if rule.line else ""
    return f"rule {access.rules.index(rule) + 1}{at}"


def _and(items: Sequence[str]) -> str:
    return " and ".join(items)


def _sorted(rule: Rule) -> list[str]:
    return [right for right in KNOWN if right in rule.may]


def _wrapped(head: str, text: str) -> list[str]:
    blank = " " * len(head)
    return wrap(
        text,
        WIDTH,
        initial_indent=head,
        subsequent_indent=blank,
        break_long_words=False,
        break_on_hyphens=False,
    )
