"""Dash: a page that shows the whole network, live, and lets people change it.

GET /          the page
GET /network   ?since=VERSION&event=NUMBER: what it shows, as JSON
GET /peek      ?port=NAME: the newest message of a port, as JSON; /peek.jpg the same as a picture
POST /form     {"admin": 1, "req": ["dash", VERB, ...]}: a change, as `dash_action.py` lists them

Rules: ports are asked while somebody looks at the page, once for all of them, and nothing but their
administrative side. A look that takes long is followed by a longer pause, so that many ports are
asked less often.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Final

import yarpy
from yarpy.kits.views.asset import jsonpage, site
from yarpy.kits.views.dash_action import Actions
from yarpy.kits.views.dash_network import View
from yarpy.kits.views.dash_peek import Peeks
from yarpy.network.sampling import Sampler

if TYPE_CHECKING:
    from yarpy.names.base import NameClient
    from yarpy.port.base import BasePort

PERIOD: Final = 1.0  # seconds between looks, at least
SHARE: Final = 0.5  # of the time in which ports are asked, at most
WANTED: Final = 10.0  # seconds that a question keeps the looks going

_FILES: Final = (
    *("dash.css", "dash_camera.js", "dash_detail.js", "dash_graph.js"),
    *("dash_layout.js", "dash_list.js", "dash_word.js"),
)


class Dash:
    """Serves the page of the network that `names` knows on `port`, until `close`."""

    def __init__(self, port: BasePort, names: NameClient) -> None:
        self._names = names
        self._view = View()
        self._peeks = Peeks()
        self._actions = Actions(names)
        self._until = 0.0
        self._wake = threading.Event()
        self._closed = threading.Event()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()  # pages ask in threads of their own
        pages = site("dash", *_FILES)
        pages["/network"] = self._network
        pages["/peek"] = self._peek
        pages["/peek.jpg"] = self._picture
        port.on_page(pages)
        port.on_admin(self._asked)

    def close(self) -> None:
        """Ask nobody any more."""
        self._closed.set()
        self._wake.set()
        if self._thread is not None:
            self._thread.join(5.0)

    # -- pages ------------------------------------------------------------------------------------

    def _network(self, fields: Mapping[str, str]) -> yarpy.Page:
        self._want()
        since, event = (_number(fields.get(key, "")) for key in ("since", "event"))
        return yarpy.Page(
            self._view.told(since, event, self._actions.undo_text), "application/json"
        )

    def _peek(self, fields: Mapping[str, str]) -> yarpy.Page:
        self._want()
        return jsonpage(self._peeks.told(fields.get("port", ""), self._view.snapshot))

    def _picture(self, fields: Mapping[str, str]) -> yarpy.Page:
        picture = self._peeks.picture(fields.get("port", ""))
        if picture is None:
            return yarpy.Page("no picture has come\n", "text/plain; charset=utf-8", 404)
        return yarpy.Page(picture, "image/jpeg")

    def _asked(self, message: yarpy.Message) -> object:
        """Do what a page asks for."""
        words = message.as_(yarpy.Bottle)
        if not words or words[0] != "dash":
            return None
        try:
            done = self._actions.act(list(words[1:]))
        except (yarpy.YarpError, ValueError) as error:
            return [yarpy.Vocab("fail"), str(error)]
        self._view.happened(f"by hand: {done}")
        self._wake.set()
        return [yarpy.Vocab("ok"), done]

    # -- looking ----------------------------------------------------------------------------------

    def _want(self) -> None:
        """Look at the network for some seconds more."""
        with self._lock:
            self._until = time.monotonic() + WANTED
            if self._thread is None and not self._closed.is_set():
                self._thread = threading.Thread(target=self._run, name="yarpy dash", daemon=True)
                self._thread.start()

    def _run(self) -> None:
        with Sampler(self._names) as sampler:
            while not self._closed.is_set():
                started = time.monotonic()
                try:
                    self._view.take(sampler.look())
                except yarpy.YarpError as error:
                    self._view.problem = str(error)
                self._peeks.rest()
                passed = time.monotonic() - started
                self._wake.wait(max(PERIOD - passed, passed * (1 / SHARE - 1)))
                self._wake.clear()
                with self._lock:
                    if time.monotonic() > self._until:
                        self._thread = None
                        break
        self._peeks.rest(everybody=True)


def _number(text: str) -> int:
    return int(text) if text.isascii() and text.isdigit() and len(text) < 16 else -1


__all__ = ["Dash"]
