"""Files of the pages that every port has: scripts and styles, at `/*/NAME`.

Rules: only what is listed here is served. Names, numbers and messages come to scripts as JSON
and are put into a page as text, so that nothing needs to be escaped. Programs use them too.
"""

from __future__ import annotations

from functools import cache
from typing import Final

PREFIX: Final = "*/"  # after the first slash of a path
KINDS: Final = {
    "main.css": "text/css; charset=utf-8",  # for the pages of C++ ports
    "style.css": "text/css; charset=utf-8",  # the look of all pages
    "port.css": "text/css; charset=utf-8",
    "port.js": "text/javascript; charset=utf-8",
    "common.js": "text/javascript; charset=utf-8",  # small texts for people
    "live.js": "text/javascript; charset=utf-8",  # pictures
    "plot.js": "text/javascript; charset=utf-8",  # curves
    "tree.js": "text/javascript; charset=utf-8",  # values
}


@cache
def asset(name: str) -> str:
    """The text of a file in KINDS, read once."""
    from importlib.resources import files

    return files("yarpy.carriers.web.http").joinpath("assets", name).read_text("utf-8")
