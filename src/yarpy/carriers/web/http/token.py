"""Web tokens: how a browser or a program shows one in HTTP, and what becomes of it.

    GET /?token=4Zr2kXqyJtWm0v8N            once, in a browser: it gets the token as a cookie
    Authorization: Bearer 4Zr2kXqyJtWm0v8N  programs

Rules: a token is a secret, so it is taken out of the request before anybody else sees it: no page,
message or log contains it, and a browser is sent on to the address without it, which it keeps and
names to others. The cookie goes to ports of the same computer alone (SameSite), and no script can
read it (HttpOnly). Where no tokens are known, `token` is an argument like any other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from yarpy.wire.effects import Claim
from yarpy.wire.steps import Steps

COOKIE: Final = "yarpy-token"
ARGUMENT: Final = "token"
UNKNOWN: Final = "Access refused: this web token is not known here"
# Links to other computers do not tell them where they stand.
REFERRER: Final = ("Referrer-Policy", "same-origin")


@dataclass(frozen=True, slots=True)
class Shown:
    """A request after its token was looked at.

    target: without the token. refusal: why it cannot go on, or "". token: what is to be a cookie
    from now on: a known token from the address.
    """

    target: str
    refusal: str = ""
    token: str = ""


def claim(target: str, headers: Mapping[str, str]) -> Steps[Shown]:
    """Show the token of a request, if it has one, to whoever knows the rules."""
    rest, token = taken(target)
    named = token or _bearer(headers)
    known = yield Claim(named or _cookie(headers))
    if known is None:
        return Shown(target)
    if known:
        return Shown(rest, token=token)
    if named:
        return Shown(rest, UNKNOWN)
    yield Claim("")  # a cookie from before
    return Shown(rest)


def taken(target: str) -> tuple[str, str]:
    """A target without its token, and the token; "" if there is none.

    >>> taken("/?req=get+encs&token=abc")
    ('/?req=get+encs', 'abc')
    >>> taken("/r?token=abc&sse")
    ('/r?sse', 'abc')
    """
    path, _, query = target.partition("?")
    pairs = [pair.partition("=") for pair in query.split("&")]
    found = [value for name, _, value in pairs if name == ARGUMENT]
    if not found:
        return target, ""
    rest = "&".join("".join(pair) for pair in pairs if pair[0] != ARGUMENT)
    return f"{path}?{rest}" if rest else path, found[0]


def cookie(token: str, secure: bool) -> tuple[str, str]:
    """The header that makes a token a cookie. `secure`: it came in TLS."""
    more = "; Secure" if secure else ""
    return "Set-Cookie", f"{COOKIE}={token}; Path=/; HttpOnly; SameSite=Strict{more}"


def _bearer(headers: Mapping[str, str]) -> str:
    scheme, _, token = headers.get("authorization", "").partition(" ")
    return token.strip() if scheme.lower() == "bearer" else ""


def _cookie(headers: Mapping[str, str]) -> str:
    for part in headers.get("cookie", "").split(";"):
        name, _, value = part.strip().partition("=")
        if name == COOKIE:
            return value
    return ""
