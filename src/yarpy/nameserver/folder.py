"""A directory as web pages: what is below `/web/` of a name server that has one.

Rules: only ordinary files that are really inside the directory are shown, wherever symbolic links
point; no name that begins with a dot. What is not there is 404. Files are read anew for each
request, large ones while they are sent.
"""

from __future__ import annotations

import stat
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Final

import yarpy
from yarpy.carriers.web.http.page import Pieces

PREFIX: Final = "/web"
PIECE: Final = 1 << 16  # bytes of a file that are in memory at a time

_TEXTS: Final = ("text/", "application/json", "application/javascript", "image/svg")


class Folder:
    """The pages of `directory`: a function for `on_page`. AddressError if it is not one."""

    def __init__(self, directory: str | Path) -> None:
        self._root = Path(directory).resolve()
        if not self._root.is_dir():
            raise yarpy.AddressError(f'"{directory}" is not a directory')

    def __call__(self, path: str, fields: Mapping[str, str]) -> yarpy.Page | None:
        if path != PREFIX and not path.startswith(f"{PREFIX}/"):
            return None
        parts = path.removeprefix(PREFIX).split("/")[1:]
        try:
            found = self._find(parts)
        except (OSError, ValueError):  # a name that is too long, or that no file can have
            found = None
        if found is None:
            # The pages of C++ ports load this from their name server, so it is always there.
            return None if path == f"{PREFIX}/main.css" else _missing("there is no such page\n")
        if found.is_dir():
            return _moved(path.rpartition("/")[2])
        try:
            with found.open("rb") as file:
                body = file.read(PIECE)
                size = found.stat().st_size
        except OSError:
            return _missing("this page cannot be read\n")
        whole = len(body) == size
        return yarpy.Page(body if whole else Pieces(size, partial(_read, found)), _kind(found))

    def _find(self, parts: list[str]) -> Path | None:
        """The file at that place; a directory where its name came without the last slash."""
        if not parts:
            return self._root
        *folders, name = parts
        if any(part.startswith(".") or "\\" in part for part in parts) or "" in folders:
            return None
        found = self._root.joinpath(*folders, name or "index.html").resolve(strict=True)
        if not found.is_relative_to(self._root):
            return None
        mode = found.stat().st_mode
        if stat.S_ISDIR(mode):
            return found if (found / "index.html").is_file() else None
        return found if stat.S_ISREG(mode) else None


def _read(path: Path) -> Iterator[bytes]:
    with path.open("rb") as file:
        while piece := file.read(PIECE):
            yield piece


def _kind(path: Path) -> str:
    import mimetypes

    kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
    return f"{kind}; charset=utf-8" if kind.startswith(_TEXTS) else kind


def _missing(text: str) -> yarpy.Page:
    return yarpy.Page(text, "text/plain; charset=utf-8", 404)


def _moved(name: str) -> yarpy.Page:
    """Redirects to the directory itself, so that relative links of its page resolve inside it."""
    from urllib.parse import quote

    target = quote(name) + "/"
    return yarpy.Page(
        f'<meta http-equiv="refresh" content="0;url={target}"><a href="{target}">{target}</a>'
    )
