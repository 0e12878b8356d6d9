"""adaptive: sends less when the connection is slow, and more again when it is not. Sender's end.

What it goes by is how long each message is under way until it was confirmed, which is to be a
little less than the stream's own period (`congestion.py`; there is the algorithm). It makes images
smaller, first by the quality of their JPEG, where the receiver's end unpacks that
(`+send.adaptive+recv.image_compression_jpeg`), then by their resolution, to a half and a quarter.
What cannot be made smaller, and what comes while a message is still under way, is dropped.

Parameters: `delay_ms`, how long a message may be under way (else nine tenths of the period, from 20
to 200); `quality`, the best JPEG, 1 to 100; `mbit`, a limit in Mbit/s, 0 for none.

Rules: the newest counts: at most one message waits, and only if it is about to leave. Questions
pass. As the monitor of a port's output nothing is known of confirmations: then `mbit` alone counts.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import inf, log
from typing import Any, Final

from yarpy.data.bottle import Property
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LocalProtocolError
from yarpy.monitors.base import Place, Taken
from yarpy.monitors.congestion import Congestion
from yarpy.route import parse_carrier
from yarpy.wire.message import CALL, Message

QUALITY: Final = 90
WORST: Final = 15  # JPEG quality: below that smaller pictures look better
COARSEST: Final = 4  # times smaller, in width and height
_COLOURS: Final = ("mono", "rgb", "rgba", "bgr", "bgra")
_NUMBERS: Final = ("mo16", "int", "sign", "dec")  # of which no mean is taken
_PERIODS: Final = (0.02, 0.2)  # seconds that a message may be under way
_SHARE: Final = 0.9  # of the stream's period
_STEEP: Final = 25.0  # points of quality for e times the bytes
_SMALLEST: Final = 16  # pixels, in width and height
_LIMITS: Final = {"delay_ms": (0.0, 60_000.0), "quality": (1.0, 100.0), "mbit": (0.0, 1e6)}


class Adaptive:
    """Makes messages small enough, or drops them."""

    def __init__(self, place: Place, clock: Callable[[], float] = time.monotonic) -> None:
        if not place.sending:
            raise LocalProtocolError(
                "adaptive belongs to the sender's end: +send.adaptive; what it sends as JPEG "
                "+recv.image_compression_jpeg unpacks"
            )
        defaults = {"delay_ms": 0.0, "quality": float(QUALITY), "mbit": 0.0}
        self._set = {k: place.number(k, v, *_LIMITS[k]) for k, v in defaults.items()}
        spec = parse_carrier(place.carrier) if place.carrier else None
        self._packs = spec is not None and "image_compression_jpeg" in dict(spec.recv)
        self._clock = clock
        self._under_way: Callable[[], int] = lambda: 0
        self._congestion = Congestion()
        self._offered = 0.0  # when the last message was offered
        self._period = 0.0  # smoothed seconds between them
        self._began = 0.0  # when the last one passed
        self._due = 0.0  # when the limit lets the next one pass
        self._quality = self._set["quality"]
        self._scale = 1
        self._skipped = 0

    # -- what it is told --------------------------------------------------------------------------

    def watch(self, under_way: Callable[[], int]) -> None:
        self._under_way = under_way

    def confirmed(self, taken: Taken) -> None:
        self._congestion.confirmed(taken.size, taken.seconds, self._goal, self._clock())

    @property
    def _goal(self) -> float:
        """Seconds that a message may be under way."""
        least, most = _PERIODS
        own = self._set["delay_ms"] / 1000
        return own or min(max(_SHARE * self._period, least), most) if self._period else most

    @property
    def _budget(self) -> float:
        """Bytes that the next message may have."""
        allowed = self._set["mbit"] * 125_000 * (self._period or self._goal)
        return min(self._congestion.budget(self._goal), allowed or inf)

    # -- messages ---------------------------------------------------------------------------------

    def accept(self, message: Message) -> bool:
        if message.key == CALL:
            return True
        now = self._clock()
        gap, self._offered = now - self._offered, now
        if gap < 10 * (self._period or gap):  # else it had paused
            self._period += (gap - self._period) / 8 if self._period else min(gap, _PERIODS[1])
        passes = now >= self._due and self._has_room(now)
        self._skipped += not passes
        if passes:
            self._began = now
        return passes

    def _has_room(self, now: float) -> bool:
        """Return whether nothing is under way, or a single message that should arrive any
        moment."""
        count = self._under_way()
        if count == 0:
            return True
        expected, passed = self._congestion.delay, now - self._began
        return count == 1 and 0.75 * expected < passed < 1.25 * expected

    def update(self, message: Message) -> Message | None:
        if message.key == CALL:
            return None
        made, size = self._smaller(message)
        if self._set["mbit"]:
            start = max(self._due, self._clock() - self._period)
            self._due = start + size / (self._set["mbit"] * 125_000)
        return made

    def _smaller(self, message: Message) -> tuple[Message | None, int]:
        """The message as it goes on, None for as it is; and its size in bytes."""
        try:
            image = message.as_(Image)
        except DecodeError:
            image = None
        code = "" if image is None else str(image.code)
        if image is not None and self._packs and code in _COLOURS:
            made = self._squeezed(image)
            return message.replaced([Vocab("jpeg"), image.code, made]), len(made)
        if image is None:
            return None, len(message.to_bytes()) if self._set["mbit"] else 0
        whole = image.array.nbytes
        if code not in (*_COLOURS, *_NUMBERS):
            return None, whole
        self._scale = self._scale_for(whole)
        if self._scale == 1:
            return None, whole
        return message.replaced(_reduced(image, self._scale)), whole // self._scale**2

    def _scale_for(self, whole: int) -> int:
        """Return the factor by which an image of `whole` bytes is to be made smaller; a finer one
        needs more room than it takes to keep it."""
        budget, scale = self._budget, 1
        while scale < COARSEST and whole / scale**2 > budget * (0.8 if scale < self._scale else 1):
            scale *= 2
        return scale

    def _squeezed(self, image: Image) -> bytes:
        """As a JPEG file that fits, if one does."""
        budget, best = self._budget, self._set["quality"]
        self._quality = min(self._quality, best)
        small = _reduced(image, self._scale)
        data = jpeg.encode(small, int(self._quality))
        worst = min(WORST, best)
        if len(data) > 1.25 * budget and self._quality > worst:  # all at once
            self._quality = max(worst, self._quality + _STEEP * log(budget / len(data)))
            data = jpeg.encode(small, int(self._quality))
        if len(data) > 1.25 * budget and self._quality <= worst and self._scale < COARSEST:
            self._scale *= 2
        elif self._scale > 1 and budget > 3 * len(data) and self._quality > best - 15:
            self._scale //= 2
            self._quality = max(worst, best - 50)
        else:
            step = 5.0 if budget == inf else _STEEP / 2 * log(budget / len(data))
            self._quality = min(best, max(worst, self._quality + min(5.0, step)))
        return data

    # -- parameters -------------------------------------------------------------------------------

    def configure(self, parameters: Property) -> None:
        for key, (least, most) in _LIMITS.items():
            value = parameters.get(key, self._set[key])
            if not isinstance(value, int | float) or not least <= value <= most:
                raise LocalProtocolError(
                    f'"{key}" takes a number from {least:g} to {most:g}, not "{value}"'
                )
        self._set.update((key, float(parameters.get(key, self._set[key]))) for key in _LIMITS)
        self._due = 0.0

    def parameters(self) -> dict[str, object]:
        return dict(self._set)

    def state(self) -> dict[str, object]:
        found: dict[str, object] = {"skipped": self._skipped, "scale": self._scale}
        if self._packs:
            found["quality_now"] = int(self._quality)
        if self._congestion.delay:
            found["delay_now_ms"] = round(self._congestion.delay * 1000, 3)
        if self._congestion.rate < inf:
            found["mbit_now"] = round(self._congestion.rate / 125_000, 3)
        return found


def _reduced(image: Image, scale: int) -> Image:
    """The image, so many times smaller in width and height, unless it is tiny then."""
    if scale == 1 or min(image.width, image.height) < scale * _SMALLEST:
        return image
    array: Any = image.array
    if str(image.code) in _COLOURS:
        while scale > 1:  # means of four pixels: no patterns arise
            rows, columns = (length // 2 * 2 for length in array.shape[:2])
            a, b = (array[row:rows:2].astype("u2") for row in (0, 1))
            both = a + b
            array = ((both[:, 0:columns:2] + both[:, 1:columns:2] + 2) >> 2).astype("u1")
            scale //= 2
    else:
        array = array[::scale, ::scale].copy()
    return Image(array, str(image.code))
