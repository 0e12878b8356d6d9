"""Whose web pages may act on a port: `YARPY_WEB_ORIGINS`.

    *                                 any page, as in C++ YARP (also if nothing is said)
    http://dash:8080 https://x.org    pages from there, and the port's own
    none                              only the port's own

Rules: a browser tells where the page is from that makes it ask; who is no browser may act in any
case. This protects people who browse, it is no password.
"""

from __future__ import annotations

import os
from collections.abc import Mapping


class Origins:
    """Whose pages may act on a port. `listed` None: those of everybody."""

    def __init__(self, listed: frozenset[str] | None) -> None:
        self.listed = listed

    def admits(self, headers: Mapping[str, str]) -> bool:
        """Whether a request comes from such a page, from the port's own, or from no browser."""
        if self.listed is None:
            return True
        origin = headers.get("origin")
        if origin is None:
            referer = headers.get("referer", "")
            scheme, _, rest = referer.partition("://")
            origin = f"{scheme}://{rest.partition('/')[0]}" if rest else None
        if origin is not None:
            return origin in self.listed or _is_own(origin, headers.get("host", ""))
        site = headers.get("sec-fetch-site")
        if site is not None:
            return site in ("same-origin", "none")
        # A browser that tells nothing may have been told to by the page.
        return "mozilla/" not in headers.get("user-agent", "").lower()

    @property
    def framing(self) -> str:
        """Who may frame pages that may act: where only some may act, nobody else. For the header
        Content-Security-Policy; empty if everybody may."""
        if self.listed is None:
            return ""
        return " ".join(["frame-ancestors 'self'", *sorted(self.listed)])


def origins_of(text: str | None = None) -> Origins:
    """What YARPY_WEB_ORIGINS says, or a text like it: `*`, or origins between blanks."""
    if text is None:
        text = os.environ.get("YARPY_WEB_ORIGINS", "*")
    words = text.replace(",", " ").split()
    if "*" in words:
        return Origins(None)
    return Origins(frozenset(word.rstrip("/").lower() for word in words if word != "none"))


def hostname(host: str) -> str:
    """The name in a Host header, without the port number."""
    if host.startswith("["):
        return host.partition("]")[0] + "]"
    return host.partition(":")[0]


def _is_own(origin: str, host: str) -> bool:
    """Whether a page is of the port itself. A name that somebody else gave this computer does not
    count: it may be theirs today and ours tomorrow."""
    name = hostname(host)
    known = name.startswith("[") or "." not in name or name.replace(".", "").isdigit()
    return origin.lower() == f"http://{host.lower()}" and (known or name.endswith(".local"))
