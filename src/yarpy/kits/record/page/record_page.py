"""RecordPage: shows what a recorder takes in a browser, and passes on what people want of it.

GET /            the page
GET /recording   state, sizes, ports and what is to be known, as JSON
POST /form       {"req": [WORD, ...]}: the words of `words`, which the port answers as to everybody

Rules: it has no state but when it began; rates are the difference of two answers. It stands at the
recorder's port of rpc, so whoever may say words there may press its buttons, and nobody else.
"""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from functools import cache, partial
from importlib.resources import files
from typing import TYPE_CHECKING, Any, Final

import yarpy
from yarpy.carriers.web.http.page import Site
from yarpy.port.base import BasePort

if TYPE_CHECKING:
    from yarpy.kits.record.capture.recorder import Recorder

NEWS: Final = 20  # lines of an answer
NEWEST: Final = 3  # files of an answer
_NAMES: Final = ("record.js", "record.css", "record_table.js")
_FILES: Final = {"/": "record.html", **{f"/{name}": name for name in _NAMES}}
_KINDS: Final = {"html": "text/html", "css": "text/css", "js": "text/javascript"}


class RecordPage:
    """Shows `recorder` on `port`; `news` are the lines that it told, the newest last."""

    def __init__(self, port: BasePort, recorder: Recorder, news: Sequence[str] = ()) -> None:
        self._recorder = recorder
        self._news = news
        self._began = time.monotonic()
        pages = Site({path: partial(_asset, name) for path, name in _FILES.items()})
        pages["/recording"] = self._recording
        port.on_page(pages)

    def _recording(self, fields: Mapping[str, str]) -> yarpy.Page:
        recorder = self._recorder
        written = recorder.files
        told = {
            "name": recorder.name,
            "state": recorder.state,
            "snapshots": recorder.snapshots,
            "failure": recorder.failure,
            "seconds": time.monotonic() - self._began,
            "files": [*map(str, written[-NEWEST:])],
            "count": len(written),
            "bytes": recorder.size,
            "held": recorder.held,
            "memory": recorder.memory,
            "free": recorder.free,
            "ports": ports(recorder),
            "news": [*self._news][-NEWS:],
        }
        return yarpy.Page(json.dumps(told), "application/json")


@cache
def _read(name: str) -> yarpy.Page:
    text = files("yarpy.kits.record.page").joinpath("assets", name).read_text("utf-8")
    return yarpy.Page(text, f"{_KINDS[name.rpartition('.')[2]]}; charset=utf-8")


def _asset(name: str, fields: Mapping[str, str]) -> yarpy.Page:
    return _read(name)


def ports(recorder: Recorder) -> list[dict[str, Any]]:
    """Return what came from each port; `there` is whether it is connected, `wanted` whether it is
    waited for."""
    counts, connected, waiting = recorder.counts, recorder.connected, {*recorder.waiting}
    found = []
    for name in sorted({*counts, *connected, *waiting}):
        count = counts.get(name)
        found.append(
            {
                "name": name,
                "there": name in connected,
                "wanted": name in waiting,
                "messages": 0 if count is None else count.messages,
                "bytes": 0 if count is None else count.bytes,
                "lost": 0 if count is None else count.lost,
                "missed": 0 if count is None else count.missed,
                "left": 0 if count is None else count.left_out,
                "replaced": 0 if count is None else count.replaced,
            }
        )
    return found
