"""Access rules: which peer may do what with the ports of this computer.

Rules: pure, but for logging what is refused. What no rule allows is refused, also to programs of
this computer. The rules are those of `access.toml`; `access_file` reads it.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Final

from yarpy.link.begin.admission import ASK, KNOWN, RIGHTS, RUN, SCRIPT, Admission, Gate, Peer
from yarpy.log import logger
from yarpy.wire.framing import REFUSED

log = logger("yarpy.access")

FILE: Final = "access.toml"
ALL: Final = "all"
REMEMBERED: Final = 1000  # refusals, so that each is logged once
TEMPORARY: Final = "/tmp/port/"  # names that a name server makes up, asked for as "..."

_PORT_RIGHTS: Final = frozenset(RIGHTS) - {"register"}
_VERBS: Final = {
    ASK: "ask anything of",
    "read": "read",
    "write": "write to",
    "administer": "administer",
    "attach": "attach monitors to",
    "register": "register or change",
    SCRIPT: "name scripts to",
    RUN: "start programs through",
}


@dataclass(frozen=True, slots=True)
class Rule:
    """One `[[allow]]`. `ports` empty: all. `line`: where it begins, 0 if that is not known."""

    who: tuple[str, ...]
    may: frozenset[str]
    ports: tuple[str, ...] = ()
    line: int = 0

    def meets(self, peer: Peer) -> bool:
        """Return whether the peer is among those of this rule."""
        return any(_is(peer, one) for one in self.who)

    def covers(self, port: str) -> bool:
        """Return whether the rule is about that port."""
        return not self.ports or any(fnmatchcase(port, pattern) for pattern in self.ports)

    def __str__(self) -> str:
        rest = self.may - frozenset(RIGHTS)
        whole = self.may >= frozenset(RIGHTS)
        rights = ", ".join((ALL, *sorted(rest)) if whole else _sorted(self.may))
        return f"{', '.join(self.who)} may {rights}: {', '.join(self.ports) or 'all ports'}"


class Access:
    """The rules of a file, its web tokens, and public keys that stand for tokens; each by name."""

    def __init__(
        self,
        rules: tuple[Rule, ...],
        tokens: Mapping[str, str] | None = None,
        path: str = FILE,
        keys: Mapping[str, str] | None = None,
    ) -> None:
        self.rules = rules
        self.tokens = dict(tokens or {})
        self.keys = dict(keys or {})
        self.path = path
        self.asks_names = any(one.startswith("tls:") for rule in rules for one in rule.who)
        self._told: OrderedDict[tuple[str, str, str], None] = OrderedDict()

    def rule_for(self, peer: Peer, right: str, port: str) -> Rule | None:
        """The first rule that lets a peer do that with the port of that name, or None."""
        for rule in self.rules:
            if (right == ASK or right in rule.may) and rule.covers(port) and rule.meets(peer):
                return rule
        return None

    def knows(self, peer: Peer) -> bool:
        """Return whether any rule is about this peer: then it may ask a name server where ports
        are."""
        return any(rule.meets(peer) for rule in self.rules)

    def token_name(self, token: str) -> str:
        """Return the name of that web token; "" if there is no such token. Takes the same time for
        all wrong ones."""
        from hmac import compare_digest  # which loads OpenSSL: where there are tokens

        shown = token.encode("utf-8", "surrogateescape")
        found = ""
        for name, secret in self.tokens.items():
            if compare_digest(shown, secret.encode()):
                found = name
        return found

    def key_name(self, key: str) -> str:
        """Return the name of that public key; "" if there is no such key."""
        return next((name for name, known in self.keys.items() if known == key), "")

    def tell(self, peer: Peer, port: str, right: str, text: str) -> None:
        """Log what was refused, unless it was before."""
        key = (peer.address, port, right)
        if key in self._told:
            return
        self._told[key] = None
        if len(self._told) > REMEMBERED:
            self._told.popitem(last=False)
        log.warning("%s: %s (%s)", port, text, self.path)


class Ruled(Admission):
    """The rights of one peer at one port, by the rules; `names`: the port is a name server."""

    open = False

    def __init__(self, access: Access, peer: Peer, port: str, names: bool = False) -> None:
        super().__init__(peer)
        self._access = access
        self._port = port
        self.directory = self._names = names
        self._rights = {right for right in KNOWN if access.rule_for(peer, right, port)}
        if names and access.knows(peer):
            # Commands are messages there; those that change something need `register`.
            self._rights |= {"read", "write"}
        # Who may name scripts is guarded: the guard says on whose behalf a command is carried out.
        plain = SCRIPT not in self._rights
        self.everything = plain and not names and self._rights >= _PORT_RIGHTS
        self.takes_tokens = bool(access.tokens or access.keys)

    def allows(self, right: str, name: str = "") -> bool:
        if name:
            if name == "...":
                name = TEMPORARY
            return self._access.rule_for(self.peer, right, name) is not None
        return right in self._rights or (right == ASK and bool(self._rights))

    def refusal(self, right: str, name: str = "") -> str:
        if self.allows(right, name):
            return ""
        text = f"{REFUSED}: {self.peer} may not {_VERBS[right]} {name or self._port}"
        may = self.rights()
        if may and not name:
            text += f", only {', '.join(may)}"
        self._access.tell(self.peer, self._port, right, text)
        return f"{text}; the {FILE} there says who may"

    def rights(self) -> list[str]:
        return _sorted(self._rights)

    def showing(self, token: str, public_key: bool = False) -> Admission | None:
        if public_key:
            if not self._access.keys:
                return self
            name = self._access.key_name(token)
        else:
            name = self._access.token_name(token)
        if token and not name:
            return None
        if name == self.peer.token:
            return self
        return Ruled(self._access, replace(self.peer, token=name), self._port, self._names)


class RuledGate(Gate):
    """The gate of a port whose owner has written rules; `names`: it is a name server."""

    def __init__(self, access: Access, port: str, names: bool = False) -> None:
        self.asks_names = access.asks_names
        self._access, self._port, self._names = access, port, names

    def admit(self, peer: Peer) -> Admission:
        return Ruled(self._access, peer, self._port, self._names)


def _is(peer: Peer, who: str) -> bool:
    if who == "anyone":
        return True
    if who == "loopback":
        return peer.here
    if who == "key":
        return peer.key
    kind, colon, name = who.partition(":")
    if colon and kind == "tls":
        return name.lower() in (known.lower() for known in peer.names)
    if colon and kind == "token":
        return name == peer.token
    return _within(peer.address, who)


def _within(address: str, network: str) -> bool:
    from ipaddress import ip_address, ip_network

    try:
        return ip_address(address.partition("%")[0]) in ip_network(network)
    except ValueError:
        return False


def _sorted(rights: frozenset[str] | set[str]) -> list[str]:
    return [right for right in KNOWN if right in rights]
