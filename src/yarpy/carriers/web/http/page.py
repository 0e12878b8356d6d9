"""Pages that a program serves to browsers on its port, beside those of the port itself.

Rules: requesting a page changes nothing; a page acts by sending messages. A page is the program's
own, so its scripts may do what the port's own page may; content from elsewhere belongs in a reply
with `(web ...)`, which browsers isolate. Messages come first: a request that carries one (`req`,
`data`, `cmd`), `/r` and `/?` never get here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

HTML = "text/html; charset=utf-8"


@dataclass(frozen=True, slots=True)
class Pieces:
    """A body that is made while it is sent: `size` bytes, in the pieces that `read()` yields."""

    size: int
    read: Callable[[], Iterable[bytes]]

    def __len__(self) -> int:
        return self.size


@dataclass(frozen=True, slots=True)
class Page:
    """An answer to a browser: `body` (a string is sent as UTF-8), its MIME type, the HTTP
    status."""

    body: str | bytes | Pieces
    kind: str = HTML
    status: int = 200

    def encoded(self) -> bytes | Pieces:
        """The body as it is sent."""
        return self.body.encode("utf-8", "replace") if isinstance(self.body, str) else self.body


#: called with the path, which begins with "/", and the arguments. A string is a page of HTML;
#: None: the port's own answer for that path
Pages: TypeAlias = Callable[[str, Mapping[str, str]], Page | str | None]


class Site(dict[str, Callable[[Mapping[str, str]], Page | str]]):
    """Pages by their paths, each a function of the arguments: what a program gives to `on_page`.
    None for every other path."""

    def __call__(self, path: str, fields: Mapping[str, str]) -> Page | str | None:
        found = self.get(path)
        return None if found is None else found(fields)
