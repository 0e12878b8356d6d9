"""Pages that a program shows to browsers on its port, beside those of the port itself.

Rules: pages are read, they change nothing: what a page wants done it sends as a message. A page is
the program's own, so its scripts may do what the port's own page may; content from elsewhere
belongs in a reply with `(web ...)`, which browsers keep apart. Messages come first: a request that
carries one (`req`, `data`, `cmd`), `/r` and `/?` are never asked for here.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

HTML = "text/html; charset=utf-8"


@dataclass(frozen=True, slots=True)
class Page:
    """What a browser gets: `body` (a string is sent as UTF-8), its MIME type, the HTTP status."""

    body: str | bytes
    kind: str = HTML
    status: int = 200

    def to_bytes(self) -> bytes:
        """The body as it travels."""
        body = self.body
        return body if isinstance(body, bytes) else body.encode("utf-8", "replace")


#: called with the path, which begins with "/", and the arguments. A string is a page of HTML;
#: None: what the port shows there otherwise
Pages: TypeAlias = Callable[[str, Mapping[str, str]], Page | str | None]
