"""Viewer: pictures side by side in a page that their ports serve themselves.

GET /         the page
GET /status   the state of each picture, as JSON
POST /form    {"admin": 1, "req": ["click", 0, x, y]}: somebody clicked on the first picture
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import yarpy
from yarpy.kits.views.asset import jsonpage, site
from yarpy.kits.views.picture import Picture


class Sink(Protocol):
    """A port that receives clicks."""

    def write(self, value: object) -> object:
        """Take `[x, y]`, or `[x0, y0, x1, y1]` for a drag; pixels from the top left."""


class Viewer:
    """The page of several pictures; each of their ports serves it.

    quality: of the JPEG files, 1 to 100. rate: most pictures per second for a browser.
    clicks: for each picture, the port that receives clicks on it.
    """

    def __init__(
        self,
        pictures: Sequence[Picture],
        quality: int = 75,
        rate: float = 30.0,
        clicks: Sequence[Sink] = (),
    ) -> None:
        self._pictures = pictures
        self._wish = f"quality={quality}&rate={rate:g}"
        self._clicks = clicks
        pages = site("view")
        pages["/status"] = lambda fields: jsonpage(self.status())
        for picture in pictures:
            picture.port.on_page(pages)
            picture.port.on_admin(self._clicked)

    def status(self) -> dict[str, Any]:
        """Return the state for the page."""
        found = [picture.status() for picture in self._pictures]
        for index, one in enumerate(found):
            one["clicks"] = index < len(self._clicks)
        return {"wish": self._wish, "pictures": found}

    def _clicked(self, message: yarpy.Message) -> object:
        match message.value:
            case ["click", int(index), *places] if 0 <= index < len(self._clicks):
                if len(places) in (2, 4) and all(isinstance(place, int) for place in places):
                    self._clicks[index].write(places)
                    return [yarpy.Vocab("ok")]
        return None
