"""The page of a name server: every port, alive or not, whose it is and what it is connected to.

    GET /          the page
    GET /ports     what it shows, as JSON

Rules: the page is files in `assets`, names and numbers come to it as JSON. Ports are asked only
while somebody looks at it. A path that is neither a page nor a command is 404.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cache, partial
from typing import Any, Final

from yarpy.carriers.web.http.page import HTML, Page, Site
from yarpy.contact import Contact
from yarpy.nameserver.folder import Folder
from yarpy.nameserver.survey import Survey

MOST: Final = 5000  # ports that a page shows
_FILES: Final = {"/": ("names.html", HTML), "/names.js": ("names.js", "text/javascript")}
# What browsers and the pages of C++ ports ask for by themselves, and the port answers.
_HABITS: Final = ("/favicon", "/web/main.css", "/form")


class NamePage:
    """The pages that a server called `name` shows to browsers: a function for `on_page`.

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
        self.site = Site({path: partial(_file, *file) for path, file in _FILES.items()})
        self.site["/ports"] = self._ports

    def __call__(self, path: str, fields: Mapping[str, str]) -> Page | str | None:
        found = self._folder(path, fields) if self._folder is not None else None
        if found is not None:
            return found
        page = self.site(path, fields)
        if page is not None:
            return page
        known = path.strip("/").partition("/")[0] in self._verbs
        if known or "admin" in fields or path.startswith(_HABITS):
            return None
        text = "no such page, nor a command of a name server: /help lists them\n"
        return Page(text, "text/plain; charset=utf-8", 404)

    def _ports(self, fields: Mapping[str, str]) -> Page:
        self._survey.want()
        return Page(json.dumps(self.told()), "application/json")

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


def _file(name: str, kind: str, fields: Mapping[str, str]) -> Page:
    return Page(_text(name), kind)


@cache
def _text(name: str) -> str:
    from importlib.resources import files

    return files("yarpy.nameserver").joinpath("assets", name).read_text("utf-8")
