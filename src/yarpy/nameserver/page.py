"""The page of a name server: every port, alive or not, whose it is and what it is connected to.

    GET /          the page
    GET /ports     what it shows, as JSON

Rules: the page is files in `assets`, names and numbers come to it as JSON. Ports are asked only
while somebody looks at it. A path that is neither a page nor a command is 404.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cache
from typing import Any, Final

from yarpy.carriers.http.page import HTML, Page
from yarpy.contact import Contact
from yarpy.nameserver.folder import Folder
from yarpy.nameserver.survey import Survey

MOST: Final = 5000  # ports that a page shows
_FILES: Final = {"/": ("names.html", HTML), "/names.js": ("names.js", "text/javascript")}
# What browsers and the pages of C++ ports ask for by themselves, and the port answers.
_HABITS: Final = ("/favicon", "/web/main.css", "/form")


class NamePage:
    """What a server called `name` shows to browsers: a function for `on_page`.

    contacts: all registrations. verbs: first words of commands. folder: files at /web/.
    """

    def __init__(
        self,
        name: str,
        contacts: Callable[[], Sequence[Contact]],
        verbs: Collection[str],
        folder: Folder | None = None,
    ) -> None:
        self._name = name
        self._contacts = contacts
        self._verbs = verbs
        self._folder = folder
        self._survey = Survey(contacts)

    def __call__(self, path: str, fields: Mapping[str, str]) -> Page | None:
        found = self._folder(path, fields) if self._folder is not None else None
        if found is not None:
            return found
        if path in _FILES:
            name, kind = _FILES[path]
            return Page(_file(name), kind)
        if path == "/ports":
            self._survey.want()
            return Page(json.dumps(self.told()), "application/json")
        known = path.strip("/").partition("/")[0] in self._verbs
        if known or "admin" in fields or path.startswith(_HABITS):
            return None
        text = "no such page, nor a command of a name server: /help lists them\n"
        return Page(text, "text/plain; charset=utf-8", 404)

    def told(self) -> dict[str, Any]:
        """Plain data for the page."""
        contacts = self._contacts()
        return {
            "name": self._name,
            "more": max(0, len(contacts) - MOST),
            "ports": [
                {
                    "name": one.name,
                    "carrier": one.carrier,
                    "host": one.host,
                    "port": one.port,
                    **self._survey.told(one),
                }
                for one in contacts[:MOST]
            ],
        }

    def close(self) -> None:
        """Ask no port any more."""
        self._survey.close()


@cache
def _file(name: str) -> str:
    from importlib.resources import files

    return files("yarpy.nameserver").joinpath("assets", name).read_text("utf-8")
