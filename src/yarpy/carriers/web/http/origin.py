"""The rules by which web pages may act on a port and read it, and the host names by which they
reach it: `YARPY_WEB_ORIGINS`.

    (nothing), none                   only the port's own page; pages of this network read
    http://dash:8080 https://x.org    pages from there too
    robot.lab.example                 every page of that computer, which may be this one
    *                                 any page, as in C++ YARP

    null                              pages that are files, and addresses that are typed in

Rules: the one place that decides about pages. A browser names the origin of the page that makes the
request; other programs may always act. This protects people who browse; it is not a password.

- Acting is for the port's own page, and those that the setting names; asking (`get`, `list`,
  `query`) for pages of this network as well.
- What a program's pages say (a dash, a panel) is for the same ones.
- What the port itself writes and says is for pages of this network as well: those of computers with
  a private address or a name without dots. No site of the internet reads what a robot sends.
- Over plain HTTP a browser does not say whether an address was typed in or a page hid itself. Such
  a request may ask (`get`, `list`, `query`), since no page can see the answer.
- A site may point its own name to this computer, so that its page passes for the port's (DNS
  rebinding). Therefore a browser must name this computer as this computer, its network or the
  setting does, or by an address. Over the loopback, which no other computer's name leads to, every
  client must. In TLS, the certificate has proved the name.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cache
from typing import Final

#: First words of messages that ask and change nothing, by YARP's custom.
QUESTIONS: Final = frozenset(("get", "help", "list", "query", "ver"))
_SHOWN: Final = 100  # characters of an origin that a refusal repeats


class Origins:
    """The pages that may act on a port: those of the `listed` origins and `hosts`.

    `listed` None: all pages.
    """

    def __init__(self, listed: frozenset[str] | None, hosts: frozenset[str] = frozenset()) -> None:
        self.listed = listed
        self.hosts = hosts

    def admits(self, headers: Mapping[str, str], secure: bool = False, asks: bool = False) -> bool:
        """Return whether a request with these headers may change something: it comes from a listed
        page, from the port's own, or from a program that is not a browser.

        `secure`: it came over TLS. `asks`: it only asks, which pages of this network may.
        """
        if self.listed is None:
            return True
        origin, host = _origin(headers), headers.get("host", "")
        if origin is not None:
            near = asks and (secure or self.knows(host)) and self._is_near(origin, host, secure)
            return near or self._is_listed(origin) or self._is_own(origin, host, secure)
        site = headers.get("sec-fetch-site")
        if site is not None:
            return site in ("same-origin", "none") and self.knows(host)
        # A browser that names no origin may do so because the page made it hide it.
        hides = self._browses(headers) and "null" not in self.listed
        return not hides or (asks and self.knows(host))

    def shows(self, headers: Mapping[str, str], secure: bool = False) -> bool:
        """Return whether the client may see the pages of a program: no page of another origin may,
        which could read them, or show them as its own."""
        if self.listed is None:
            return True
        origin = headers.get("origin")
        if origin is not None:
            origin = origin.lower()
            return self._is_listed(origin) or self._is_own(origin, headers.get("host", ""), secure)
        # Somebody may follow a link that is elsewhere: the page there does not see where it leads.
        loads = headers.get("sec-fetch-mode") != "navigate"
        return not (loads and headers.get("sec-fetch-site") in ("cross-site", "same-site"))

    def reads(self, headers: Mapping[str, str], secure: bool = False) -> bool:
        """Return whether the client may see what the port itself writes and says: no page of
        another network may."""
        if self.listed is None:
            return True
        origin = headers.get("origin")
        if origin is None:
            if headers.get("sec-fetch-site") != "cross-site":
                return True
            if headers.get("sec-fetch-mode") == "navigate":
                return True
            origin = _origin(headers) or "null"
        origin = origin.lower()
        return self._is_listed(origin) or self._is_near(origin, headers.get("host", ""), secure)

    def refusal(
        self, headers: Mapping[str, str], reached: str, secure: bool, acts: bool = False
    ) -> tuple[int, str] | None:
        """Return the status and text with which a request is refused for the page that makes it;
        None if the page may read here and, where the request `acts`, act.

        `reached`: the address at which it arrived.
        """
        if self.turns_away(headers, reached, secure):
            return 421, not_ours(headers.get("host", ""))
        if not self.reads(headers, secure):
            return 403, may_not_read(self, headers)
        if acts and not self.admits(headers, secure):
            return 403, may_not_act(self, headers)
        return None

    def reader_of(self, headers: Mapping[str, str]) -> str:
        """The origin that browsers let read a program's page, besides its own; "" for none."""
        origin = headers.get("origin", "")
        if self.listed is None:
            return "*"
        return origin if origin and self._is_listed(origin.lower()) else ""

    def knows(self, host: str) -> bool:
        """Return whether a Host header may name this computer: an address, a name of this network,
        or one of `hosts`. Any other may belong to a site that points its name to us."""
        name = hostname(host.lower())
        return (
            self._is_certain(name)
            or "." not in name
            or name.endswith((".local", ".localhost"))
            or name in own_names()
        )

    def turns_away(self, headers: Mapping[str, str], reached: str, secure: bool = False) -> bool:
        """Return whether to refuse a request because its Host names another computer. `reached`:
        the address at which it arrived, a loopback one if the name led there."""
        if not (reached.startswith("127.") or reached == "::1"):
            # Within a network, computers have names that only a browser could have been tricked by.
            return not secure and self._browses(headers) and not self.knows(headers.get("host", ""))
        name = hostname(headers.get("host", "").lower())
        ours = self._is_certain(name) or name in own_names() or name.endswith(".localhost")
        return bool(name) and not ours  # HTTP/1.0 need not name any

    def opening(self, headers: Mapping[str, str]) -> str:
        """The setting with which the page of a request could act."""
        listed = self.listed or frozenset()
        more = (_origin(headers) or "null")[:_SHOWN]
        if not more.replace("://", "").replace(":", "").replace(".", "").replace("-", "").isalnum():
            more = "ORIGIN"
        words = " ".join([*sorted(listed | self.hosts), more])
        return f'YARPY_WEB_ORIGINS="{words}"' if " " in words else f"YARPY_WEB_ORIGINS={words}"

    def _browses(self, headers: Mapping[str, str]) -> bool:
        """Return whether the client is a browser. A page may change what its own browser says of
        itself, which only counts where a name may lead to us that is not ours."""
        return "mozilla/" in headers.get("user-agent", "").lower() or (
            "accept-language" in headers and not self.knows(headers.get("host", ""))
        )

    def _is_near(self, origin: str, host: str, secure: bool) -> bool:
        """Return whether a page is of this computer or of this network."""
        name = hostname(origin.partition("://")[2])
        if not name:
            return False
        if name == hostname(host.lower()) and (secure or self.knows(host)):
            return True  # another port of the same computer
        return _is_private(name) if self._is_certain(name) else self.knows(name)

    def _is_listed(self, origin: str) -> bool:
        listed = self.listed or frozenset()
        return origin in listed or hostname(origin.partition("://")[2]) in self.hosts

    def _is_certain(self, name: str) -> bool:
        """An address is no name that could have been borrowed."""
        return (
            self.listed is None
            or name.startswith("[")
            or (name.isascii() and name.replace(".", "").isdigit())
            or name in self.hosts
        )

    def _is_own(self, origin: str, host: str, secure: bool) -> bool:
        """Return whether a page belongs to the port itself."""
        scheme = "https" if secure else "http"
        return origin == f"{scheme}://{host.lower()}" and (secure or self.knows(host))

    @property
    def framing(self) -> str:
        """The origins that may frame pages that may act, namely those that may act themselves. For
        the header Content-Security-Policy; empty if all may.
        """
        if self.listed is None:
            return ""
        hosts = [f"{scheme}://{host}:*" for host in sorted(self.hosts) for scheme in _SCHEMES]
        return " ".join(["frame-ancestors 'self'", *sorted(self.listed), *hosts])


def _origin(headers: Mapping[str, str]) -> str | None:
    """The origin of the page that makes a request, None if none is named."""
    origin = headers.get("origin")
    if origin is None:
        scheme, _, rest = headers.get("referer", "").partition("://")
        origin = f"{scheme}://{rest.partition('/')[0]}" if rest else None
    return None if origin is None else origin.lower()


def _is_private(name: str) -> bool:
    """Return whether this address is one that the internet does not lead to."""
    import ipaddress  # late: few requests need it

    try:
        address = ipaddress.ip_address(name.strip("[]").partition("%")[0])
    except ValueError:
        return False
    return address.is_private or address.is_link_local or address.is_loopback


@cache
def own_names() -> frozenset[str]:
    """The names by which this computer knows itself, in lower case: also with the domains in which
    it looks for others."""
    import platform  # late: few requests need it

    node = platform.node().lower()
    short = node.partition(".")[0]
    names = {"localhost", node, short} - {""}
    full = (f"{short}.{domain}" for domain in _domains() if short)
    more = (f"{name}.local" for name in names)
    return frozenset((*names, *more, *full, "localhost.localdomain"))


def _domains(path: str = "/etc/resolv.conf") -> list[str]:
    """The domains of this network, as the resolver knows them."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            lines = [line.lower().split() for line in file.read(1 << 14).splitlines()]
    except OSError:
        return []  # not on every system
    found = [word for line in lines if line[:1] in (["search"], ["domain"]) for word in line[1:]]
    return [word.strip(".") for word in found if word.strip(".")]


_SCHEMES = ("http", "https")


def origins_of(text: str | None = None) -> Origins:
    """The value of YARPY_WEB_ORIGINS, or of `text`: `*`, or origins and hosts between blanks."""
    if text is None:
        text = os.environ.get("YARPY_WEB_ORIGINS", "")
    words = {word.rstrip("/").lower() for word in text.replace(",", " ").split()} - {"none"}
    if "*" in words:
        return Origins(None)
    listed = frozenset(word for word in words if "://" in word or word == "null")
    return Origins(listed, frozenset(words) - listed)


def not_ours(host: str) -> str:
    """The text for a request that was refused."""
    name = "".join(c for c in hostname(host) if c.isalnum() or c in ".-_")[:80]
    return (
        f"this computer is not known as {name}: use its address, or start the program that opened "
        f"the port with YARPY_WEB_ORIGINS={name}"
    )


def may_not_read(origins: Origins, headers: Mapping[str, str]) -> str:
    """The text for a page that may not even read."""
    return (
        "only pages of this network and programs other than browsers may read here: start the "
        f"program that opened the port with {origins.opening(headers)}"
    )


def may_not_act(origins: Origins, headers: Mapping[str, str]) -> str:
    """The text for a page that may not act, or may not see a program's page."""
    return (
        "only the port's own page and programs other than browsers may act here: open the port's "
        f"page, or start the program that opened the port with {origins.opening(headers)}"
    )


def hostname(host: str) -> str:
    """The name in a Host header, without the port number."""
    if host.startswith("["):
        return host.partition("]")[0] + "]"
    return host.partition(":")[0]
