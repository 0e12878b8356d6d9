"""Which web pages may act on a port, and by which host names: `YARPY_WEB_ORIGINS`.

    (nothing), none                   only the port's own page
    http://dash:8080 https://x.org    pages from there too
    robot.lab.example                 every page of that computer, which may be this one
    *                                 any page, as in C++ YARP

Rules: a browser names the origin of the page that makes the request; other programs may always act.
This protects people who browse; it is not a password. Reading is open to every page, as in C++
YARP. A site may point its own name to this computer, so that its page passes for the port's (DNS
rebinding): therefore a name with dots that is not listed is not ours, and a request with it over
the loopback, which no other computer's name leads to, is refused.
"""

from __future__ import annotations

import os
from collections.abc import Mapping


class Origins:
    """Which pages may act on a port: those of the `listed` origins and `hosts`.

    `listed` None: all pages.
    """

    def __init__(self, listed: frozenset[str] | None, hosts: frozenset[str] = frozenset()) -> None:
        self.listed = listed
        self.hosts = hosts

    def admits(self, headers: Mapping[str, str], secure: bool = False) -> bool:
        """Whether a request comes from such a page, from the port's own, or from a program that is
        not a browser.

        `secure`: it came over TLS.
        """
        if self.listed is None:
            return True
        origin = headers.get("origin")
        if origin is None:
            referer = headers.get("referer", "")
            scheme, _, rest = referer.partition("://")
            origin = f"{scheme}://{rest.partition('/')[0]}" if rest else None
        if origin is not None:
            origin = origin.lower()
            return (
                origin in self.listed
                or hostname(origin.partition("://")[2]) in self.hosts
                or self._is_own(origin, headers.get("host", ""), secure)
            )
        site = headers.get("sec-fetch-site")
        if site is not None:
            return site in ("same-origin", "none") and self.knows(headers.get("host", ""))
        # A browser that names no origin may do so because the page made it hide it.
        return "mozilla/" not in headers.get("user-agent", "").lower()

    def knows(self, host: str) -> bool:
        """Whether a Host header may name this computer: an address, a name of this network, or one
        of `hosts`. Any other may belong to a site that points its name to us."""
        name = hostname(host.lower())
        return (
            self.listed is None
            or name.startswith("[")
            or "." not in name
            or name.replace(".", "").isdigit()
            or name.endswith((".local", ".localhost"))
            or name in self.hosts
        )

    def turns_away(self, headers: Mapping[str, str], reached: str) -> bool:
        """Whether to refuse a request because its Host names another computer. `reached`: the
        address at which it arrived, a loopback one if the name led there."""
        if not (reached.startswith("127.") or reached == "::1"):
            return False  # within a network, computers may have any name
        return not self.knows(headers.get("host", ""))

    def _is_own(self, origin: str, host: str, secure: bool) -> bool:
        """Whether a page belongs to the port itself."""
        scheme = "https" if secure else "http"
        return origin == f"{scheme}://{host.lower()}" and self.knows(host)

    @property
    def framing(self) -> str:
        """Which origins may frame pages that may act, namely those that may act themselves. For the
        header Content-Security-Policy; empty if all may.
        """
        if self.listed is None:
            return ""
        hosts = [f"{scheme}://{host}:*" for host in sorted(self.hosts) for scheme in _SCHEMES]
        return " ".join(["frame-ancestors 'self'", *sorted(self.listed), *hosts])


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
        f"this computer is not known as {name}: use its address, or list the name in "
        "YARPY_WEB_ORIGINS where the port was opened"
    )


def hostname(host: str) -> str:
    """The name in a Host header, without the port number."""
    if host.startswith("["):
        return host.partition("]")[0] + "]"
    return host.partition(":")[0]
