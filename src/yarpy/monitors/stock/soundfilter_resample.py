"""soundfilter_resample: pick one channel of a sound, change its volume or its rate.

Parameters, as in C++ YARP: `channel` (from 0; default all), `gain_percent` (100: unchanged),
`frequency` (samples per second), applied in this order. Either end.

Rules: another rate needs soxr (extra `sound`), the library of C++ YARP; each message is resampled
on its own. C++ resamples single channels only. Samples that get too loud are clipped.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yarpy.data.sig.sound import Sound
from yarpy.errors import DecodeError
from yarpy.limit import limits
from yarpy.monitors.base import Place
from yarpy.monitors.extra import needed
from yarpy.wire.message import Message

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MOST = 1_000_000  # samples per second


class SoundFilterResample:
    """Applies a channel, a gain and a rate."""

    def __init__(self, place: Place) -> None:
        self._channel = int(place.number("channel", -1, -1))
        self._gain = place.number("gain_percent", 100.0, 0) / 100
        self._frequency = int(place.number("frequency", 0, 1, _MOST))
        self._limit = min(place.limit, limits().unpacked)
        if self._frequency:
            self._soxr = needed("soxr", "sound", "soundfilter_resample")

    def update(self, message: Message) -> Sound:
        import numpy as np

        sound = message.as_(Sound)
        samples: NDArray[Any] = sound.array
        if self._channel >= 0:
            if self._channel >= sound.channels:
                raise DecodeError(f"no channel {self._channel}: the sound has {sound.channels}")
            samples = samples[self._channel : self._channel + 1]
        if self._gain != 1:
            louder = np.trunc(samples * self._gain)
            samples = np.clip(louder, -0x8000, 0x7FFF).astype("<i2")
        rate = sound.frequency
        if self._frequency and rate != self._frequency and samples.size:
            if rate <= 0 or samples.nbytes * self._frequency > rate * self._limit:
                raise DecodeError(f"a sound of {rate} samples per second cannot be resampled")
            samples = self._soxr.resample(samples.T, rate, self._frequency).T
            rate = self._frequency
        return Sound(samples, rate)
