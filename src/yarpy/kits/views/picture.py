"""Picture: a port that receives images, and shows the latest one to browsers.

Rules: images are sent on to browsers as MJPEG, as fast as each can take them. Images with more than
256 greys, or of measurements, are stretched to the visible range. Messages that are not pictures
are counted and described, and do no harm.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

import yarpy

if TYPE_CHECKING:
    from numpy.typing import NDArray

LOOK: Final = 0.25  # seconds between looks for new watchers
MEMORY: Final = 3.0  # seconds that the frame rate looks back
_SEEN: Final = ("mono", "rgb", "rgba", "bgr", "bgra")
_STRETCHED: Final = ("mo16", "int", "dec")


class Picture:
    """One image port; `status` is what a page tells about it. The port is the caller's to close."""

    def __init__(self, port: yarpy.BufferedPort) -> None:
        self.port = port
        self._waiting = ""
        self._newest: tuple[yarpy.Image, str] | None = None
        self._times: deque[float] = deque(maxlen=500)
        self._frames = 0
        self._kind: dict[str, Any] = {}
        self._others = 0
        self._complaint = ""
        self._missing = Missing()
        threading.Thread(target=self._run, name=f"yarpy view {port.name}", daemon=True).start()

    def wait_for(self, line: str) -> None:
        """Show what the picture is waiting for; "": nothing."""
        self._waiting = line

    def status(self) -> dict[str, Any]:
        """Plain data for a page: times in seconds, rates in 1/s."""
        now = time.monotonic()
        times = [moment for moment in tuple(self._times) if now - moment < MEMORY]
        span = times[-1] - times[0] if len(times) > 1 else 0.0
        replaced, drops = self._missing.count(self.port)
        return {
            "name": self.port.name,
            "port": self.port.contact.port,
            "sources": [{"name": link.source, "carrier": link.carrier} for link in self._inputs()],
            "waiting": self._waiting,
            "frames": self._frames,
            "rate": (len(times) - 1) / span if span else 0.0,
            "age": now - self._times[-1] if self._times else None,
            "replaced": replaced,
            "drops": drops,
            "others": self._others,
            "complaint": self._complaint,
            **self._kind,
        }

    def _inputs(self) -> list[Any]:
        return [link for link in self.port.inputs if link.source != "web"]

    def _run(self) -> None:
        while True:
            try:
                message = self.port.read(timeout=LOOK)
            except yarpy.Timeout:
                self._show_newcomers()
                continue
            except yarpy.PortClosed:
                return
            self._take(message)

    def _take(self, message: yarpy.Message) -> None:
        try:
            image = message.as_(yarpy.Image)
            shown, span = visible(image)
        except ValueError as error:  # DecodeError is one
            self._complaint = f"{message.source or 'somebody'}: {_described(message, error)}"
            self._others += 1
            return
        self._frames += 1
        self._times.append(time.monotonic())
        size = {"width": image.width, "height": image.height, "pixel": str(image.code)}
        self._kind = {**size, "range": span}
        self._newest = shown, message.envelope
        self._write()

    def _show_newcomers(self) -> None:
        """Show the last picture to watchers that joined after it arrived."""
        self._missing.count(self.port)
        new = any(not link.stats.messages for link in self.port.outputs)
        if self._newest is not None and new:
            self._write()

    def _write(self) -> None:
        assert self._newest is not None
        try:
            self.port.write(*self._newest)
        except yarpy.PortClosed:
            pass  # the next read ends the loop


class Missing:
    """Messages that the inputs of a port left out for newer ones, and those that they lost; inputs
    that are gone count, too."""

    def __init__(self) -> None:
        self._past = (0, 0)
        self._present: dict[tuple[str, float], tuple[int, int]] = {}
        self._lock = threading.Lock()  # pages and the reader count

    def count(self, port: yarpy.BufferedPort) -> tuple[int, int]:
        """The totals so far: replaced, and dropped."""
        with self._lock:
            found = {}
            for link in port.inputs:
                stats = link.stats
                found[link.source, stats.since] = stats.replaced, stats.drops
            gone = [told for key, told in self._present.items() if key not in found]
            self._past = _total([self._past, *gone])
            self._present = found
            return _total([self._past, *found.values()])


def _total(told: Iterable[tuple[int, int]]) -> tuple[int, int]:
    replaced, drops = zip(*told, strict=True)
    return sum(replaced), sum(drops)


def visible(image: yarpy.Image) -> tuple[yarpy.Image, tuple[float, float] | None]:
    """The image in colours or 256 greys, and the values shown as black and white if it was
    stretched. ValueError if it cannot be shown."""
    if not (image.width and image.height):
        raise ValueError("a picture without pixels")
    if str(image.code) not in (*_SEEN, *_STRETCHED):
        image = _converted(image)
    return _stretched(image.array) if str(image.code) in _STRETCHED else (image, None)


def _converted(image: yarpy.Image) -> yarpy.Image:
    for target in ("mono",) if image.code == "sign" else ("rgb", "mono", "mo16"):
        try:
            return image.converted(target)
        except ValueError:
            continue
    raise ValueError(f"pictures of pixels {str(image.code)!r} cannot be shown")


def _stretched(array: NDArray[Any]) -> tuple[yarpy.Image, tuple[float, float]]:
    import numpy as np

    values = array.astype("f4")
    known = np.isfinite(values)
    seen = values if known.all() else values[known]
    low, high = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 0.0)
    grey = np.where(known, values, low) - np.float32(low)
    grey *= 255 / (high - low) if high > low else 0
    return yarpy.Image(grey.astype("u1")), (low, high)


def _described(message: yarpy.Message, error: ValueError) -> str:
    """Return what arrived instead of a picture, for people."""
    if not isinstance(error, yarpy.DecodeError):
        return str(error)
    try:
        text = message.as_(yarpy.Bottle).to_text()
    except yarpy.DecodeError:
        return f"{len(message.payload)} bytes that are not a picture"
    return f"{text[:80]}{'...' if len(text) > 80 else ''}"
