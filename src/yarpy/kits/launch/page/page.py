"""Up: a page that shows a running application, and starts and stops its programs.

GET /              the page
GET /application   programs, connections, and which program has which port, as JSON
GET /lines         ?name=PROGRAM&since=NUMBER&most=COUNT: what programs have printed, as JSON
POST /form         {"admin": 1, "req": ["up", WORD, ...]}, where WORD is `start NAME`, `stop NAME`,
                   `restart NAME`, `connect FROM TO`, `disconnect FROM TO` or `down`

Rules: it does what the commands do, through the same service, and nothing else; it has no state but
the owners of ports. Who may reach it is decided by `gate`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

import yarpy
from yarpy.kits.launch.page.owner import Owners
from yarpy.kits.views.asset import jsonpage, site
from yarpy.port.base import BasePort

MOST: Final = 2000  # lines of one answer
_NAMED: Final = ("start", "stop", "restart")
_JOINED: Final = ("connect", "disconnect")
_GRAPH: Final = ("dash.css", "dash_graph.js", "dash_layout.js", "dash_word.js")

Answer = Callable[[dict[str, Any]], dict[str, Any]]


class ApplicationPage:
    """Shows on `port` what `answer` (as `console/service.py`) tells. `owners` finds the programs of
    ports, of those that `modules` gives."""

    def __init__(
        self, port: BasePort, answer: Answer, owners: Owners, modules: Callable[[], Any]
    ) -> None:
        self._answer = answer
        self._owners = owners
        self._modules = modules
        pages = site("up", "up.css", "up_list.js", room="yarpy.kits.launch.page", shared=_GRAPH)
        pages["/application"] = self._application
        pages["/lines"] = self._lines
        port.on_page(pages)
        port.on_admin(self._asked)

    def _application(self, fields: Mapping[str, str]) -> yarpy.Page:
        told = self._answer({"do": "status"})
        ports = {one[end]: False for one in told["connections"] for end in ("from", "to")}
        for one in told["connections"]:
            if one["state"] == "connected":
                ports[one["from"]] = ports[one["to"]] = True
        there = {name for name, known in ports.items() if known}
        owners = self._owners.find([*ports], there, self._modules())
        return jsonpage({**told, "ports": [*map(list, zip(ports, owners, strict=True))]})

    def _lines(self, fields: Mapping[str, str]) -> yarpy.Page:
        since, most = (_number(fields.get(key, "")) for key in ("since", "most"))
        asked = {"do": "logs", "name": fields.get("name", ""), "since": since}
        try:
            return jsonpage(self._answer({**asked, "most": min(most, MOST)}))
        except yarpy.YarpError as error:
            return jsonpage({"error": str(error)})

    def _asked(self, message: yarpy.Message) -> object:
        """Do what a page asks for."""
        words = message.as_(yarpy.Bottle)
        if not words or words[0] != "up":
            return None
        try:
            match [str(word) for word in words[1:]]:
                case [word, name] if word in _NAMED:
                    self._answer({"do": word, "name": name})
                case [word, source, target] if word in _JOINED:
                    self._answer({"do": word, "from": source, "to": target})
                case ["down"]:
                    self._answer({"do": "down"})
                case _:
                    raise yarpy.LocalProtocolError("a page of another version: load it again")
        except yarpy.YarpError as error:
            return [yarpy.Vocab("fail"), str(error)]
        return [yarpy.Vocab("ok")]


def _number(text: str) -> int:
    return int(text) if text.isascii() and text.isdigit() and len(text) < 16 else 0
