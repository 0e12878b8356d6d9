"""Log in to a camera that wants a user name and a password: HTTP's digest and basic schemes.

    mjpeg+path.video+user.NAME+password.WORD            %2B for a plus, %25 for %

    WWW-Authenticate: Digest realm="cam", nonce="6a9f", qop="auth", algorithm=SHA-256
    Authorization: Digest username="NAME", realm="cam", nonce="6a9f", ... response="..."

Rules: pure; a password is sent only when the camera asks for it. The strongest digest on offer is
used, the first among equals; the password itself is sent only to a camera that offers no digest.
What a camera sends is limited in size before it is parsed, and quoted when sent back. Source: RFC
7616, and RFC 2617 for cameras without `qop`.
"""

from __future__ import annotations

import re
import secrets
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from yarpy.errors import LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.limit import HTTP_CHALLENGE_VALUE, HTTP_CHALLENGES
from yarpy.route import Route

_STRENGTH: Final = {"md5": 1, "sha-256": 2}
_PIECE: Final = re.compile(r'(?>(?:[^,"]++|"[^"\\]*+(?>(?:\\.[^"\\]*+)*)"?+)+)')
_PARAMETER: Final = re.compile(r"(?:([^\s=\"]++)\s++(?!=))?([^\s=\"]++)\s*+=\s*+(.*)")
_CONTROL: Final = re.compile(r"[\x00-\x1f\x7f]")


@dataclass(frozen=True, slots=True)
class Challenge:
    """One login scheme that a camera offers, with its parameters; names in lower case."""

    scheme: str
    values: dict[str, str] = field(default_factory=dict)

    @property
    def algorithm(self) -> str:
        """The digest's hash algorithm, as the camera spells it."""
        return self.values.get("algorithm") or "MD5"

    @property
    def strength(self) -> int:
        """The strength of the digest; 0 for an unsupported one."""
        if self.qop not in ("", "auth"):
            return 0
        return _STRENGTH.get(self.algorithm.lower().removesuffix("-sess"), 0)

    @property
    def qop(self) -> str:
        """`auth` if the camera offers it, "" for the older digest without `qop`, else its value."""
        wanted = self.values.get("qop", "").strip()
        return "auth" if "auth" in re.split(r"[\s,]+", wanted.lower()) else wanted


@dataclass(frozen=True, slots=True)
class Login:
    """Name and password, as UTF-8 bytes."""

    user: bytes
    password: bytes = field(repr=False)

    def answer(
        self, wanted: str, target: bytes, random: Callable[[int], bytes] = secrets.token_bytes
    ) -> bytes:
        """The value of `Authorization` for a GET of `target`.

        wanted: all `WWW-Authenticate` values. Raises LoginRefused if nothing supported is offered,
        RemoteProtocolError for a malformed challenge, LocalProtocolError.
        """
        challenges = parse_challenges(wanted)
        digests = [item for item in challenges if item.scheme == "digest"]
        if digests:
            best = max(digests, key=lambda item: item.strength)
            if best.strength:
                return self.digest(best, target, random(16).hex().encode())
            unknown = f"digest authentication with {_shown(best.algorithm)}"
            if best.qop not in ("", "auth"):
                unknown += f" and {_shown(best.qop)}"
        elif not challenges or any(item.scheme == "basic" for item in challenges):
            return self.basic()  # what a camera that does not name a scheme usually means
        else:
            unknown = f"{_shown(challenges[0].scheme)} authentication"
        raise LoginRefused(
            f"the camera wants {unknown}, which yarpy does not support; configure the camera for "
            "digest authentication with SHA-256 or MD5, or for viewing without a password"
        )

    def basic(self) -> bytes:
        """Name and password in the clear; base64 hides nothing."""
        from base64 import b64encode

        return b"Basic " + b64encode(self.user + b":" + self.password)

    def digest(self, challenge: Challenge, target: bytes, cnonce: bytes) -> bytes:
        """The answer to a supported digest challenge, with our random `cnonce`."""
        from hashlib import new

        values = {key: _returned(challenge.values, key) for key in ("realm", "nonce", "opaque")}
        nonce = values["nonce"]
        if not nonce:
            raise RemoteProtocolError("the camera wants digest authentication but sends no nonce")
        algorithm = challenge.algorithm.lower()
        name = algorithm.removesuffix("-sess").replace("-", "")

        def hashed(*parts: bytes) -> bytes:
            return new(name, b":".join(parts), usedforsecurity=False).hexdigest().encode()

        secret = hashed(self.user, values["realm"], self.password)
        if algorithm.endswith("-sess"):
            secret = hashed(secret, nonce, cnonce)
        request = hashed(b"GET", target)
        # The nonce count: each nonce is used for a single answer.
        extra = (b"00000001", cnonce, b"auth") if challenge.qop else ()
        parts = [
            b"username=" + _quoted(self.user),
            b"realm=" + _quoted(values["realm"]),
            b"nonce=" + _quoted(nonce),
            b"uri=" + _quoted(target),
            b"response=" + _quoted(hashed(secret, nonce, *extra, request)),
        ]
        if "algorithm" in challenge.values:
            parts.append(b"algorithm=" + challenge.algorithm.encode())
        if extra:
            parts += [b"qop=auth", b"nc=00000001"]
        if extra or algorithm.endswith("-sess"):
            parts.append(b"cnonce=" + _quoted(cnonce))
        if "opaque" in challenge.values:
            parts.append(b"opaque=" + _quoted(values["opaque"]))
        return b"Digest " + b", ".join(parts)


def take_login(route: Route) -> Login | None:
    """The login in a route's carrier string, if there is one.

    Raises LocalProtocolError for a name that HTTP cannot express.
    """
    from urllib.parse import unquote_to_bytes

    words = [route.spec.value(key) for key in ("user", "password")]
    if words == [None, None]:
        return None
    user, password = (unquote_to_bytes((w or "").encode("utf-8", "surrogateescape")) for w in words)
    if b":" in user or _CONTROL.search((user + password).decode("latin-1")):
        raise LocalProtocolError(
            "a user name cannot contain a colon, nor can it or the password have control characters"
        )
    return Login(user, password)


def parse_challenges(text: str) -> list[Challenge]:
    """The challenges in one or more `WWW-Authenticate` lines, joined by commas.

    text: Latin-1, as headers are read, so that the same bytes go back. Anything that cannot be
    understood is skipped. Raises RemoteProtocolError if the text is too long.
    """
    if len(text) > HTTP_CHALLENGES:
        raise RemoteProtocolError(
            f"the camera's login challenge has {len(text)} characters; the limit is "
            f"{HTTP_CHALLENGES}"
        )
    found: list[Challenge] = []
    for piece in _PIECE.findall(text):
        piece = piece.strip()
        match = _PARAMETER.fullmatch(piece)
        scheme = match[1] if match else piece.partition(" ")[0]
        if scheme:
            found.append(Challenge(scheme.lower()))
        if match and found:
            found[-1].values.setdefault(match[2].lower(), _unquoted(match[3]))
    return found


def refusal(wanted: str, login: Login | None) -> LoginRefused:
    """The error for a user whom a camera does not accept."""
    if login is None:
        return LoginRefused(
            "the camera wants a name and a password: mjpeg+path.<path>+user.<name>+password.<word>"
        )
    if any(item.values.get("stale", "").lower() == "true" for item in parse_challenges(wanted)):
        return LoginRefused("the camera did not accept its own nonce; connect again")
    return LoginRefused(
        "the camera does not accept this name and password: check both (a plus is %2B, a percent "
        "sign %25), and whether this user may view the stream"
    )


def _returned(values: dict[str, str], key: str) -> bytes:
    """A value from the camera, in the form in which it is sent back."""
    value = values.get(key, "")
    if len(value) > HTTP_CHALLENGE_VALUE:
        raise RemoteProtocolError(
            f"the camera's {key} has {len(value)} characters; the limit is {HTTP_CHALLENGE_VALUE}"
        )
    if _CONTROL.search(value):
        raise RemoteProtocolError(f"there are control characters in the camera's {key}")
    return value.encode("latin-1")


def _shown(text: str) -> str:
    """A camera's word as shown in error messages."""
    return "".join(c for c in text[:40] if c.isprintable())


def _unquoted(text: str) -> str:
    if not text.startswith('"'):
        return text
    return re.sub(r"\\(.)", r"\1", text[1:].removesuffix('"'))


def _quoted(value: bytes) -> bytes:
    return b'"' + value.replace(b"\\", b"\\\\").replace(b'"', b'\\"') + b'"'
