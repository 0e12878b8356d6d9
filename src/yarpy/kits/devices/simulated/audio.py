"""SimulatedMicrophone, SimulatedSpeaker: one hears a tone, one plays to nobody; fakeMicrophone and
fakeSpeaker in C++.

Rules: they live by the clock that they are given. So many samples are kept at most; the oldest are
forgotten. Thread-safe.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final

import yarpy
from yarpy import clock
from yarpy.kits.devices.interfaces.media import AudioSize, AudioStatus
from yarpy.kits.devices.refusal import Refused

#: Samples a second, and those that are kept.
RATE: Final = 16000
KEPT: Final = 10 * RATE


class SimulatedMicrophone:
    """Every member of `interfaces.audio.AudioRecorder`."""

    def __init__(self, clock: Callable[[], float] = clock.monotonic, tone: float = 440.0) -> None:
        self._clock = clock
        self._tone = tone
        self._lock = threading.Lock()  # what is taken is gone
        self._gain = 1.0
        self._since: float | None = None  # when it began, and how much was taken since
        self._taken = 0
        self._left = 0  # recorded before it was stopped

    def start(self) -> None:
        """Begin."""
        with self._lock:
            if self._since is None:
                self._since, self._taken = self._clock(), 0

    def stop(self) -> None:
        """Stop; what was recorded is kept."""
        with self._lock:
            self._left, self._since = self._recorded(), None

    def recording(self) -> bool:
        """Return whether it records."""
        return self._since is not None

    def sound(self, least: int = 0, most: int = 11250, timeout: float = 1.0) -> yarpy.Sound:
        """Return what was recorded, at once: nobody is waited for."""
        import numpy as np

        with self._lock:
            count = min(self._recorded(), max(most, 0))
            if self._since is None:
                self._left -= count
            first, self._taken = self._taken, self._taken + count
            time = (first + np.arange(count)) / RATE
            samples = np.clip(
                self._gain * 8000 * np.sin(2 * np.pi * self._tone * time), -32767, 32767
            )
            return yarpy.Sound(samples.astype("int16"), RATE)

    def clear(self) -> None:
        """Forget it."""
        with self._lock:
            self._left = 0
            if self._since is not None:
                self._since, self._taken = self._clock(), 0

    def amplify(self, gain: float) -> None:
        """Multiply by this."""
        if gain < 0:
            raise Refused(f"a gain is not negative: {gain}")
        self._gain = gain

    amplify_input = amplify

    def buffer_size(self) -> AudioSize:
        """Return how much is recorded."""
        with self._lock:
            count = self._recorded()
        return AudioSize(count, 1, 2, count)

    def buffer_limit(self) -> AudioSize:
        """Return how much is kept at most."""
        return AudioSize(KEPT, 1, 2, KEPT)

    def status(self) -> AudioStatus:
        """Return how it is."""
        return AudioStatus(self.recording(), self.buffer_size().samples, KEPT)

    def _recorded(self) -> int:
        if self._since is None:
            return self._left
        count = int((self._clock() - self._since) * RATE) - self._taken
        return max(0, min(count, KEPT))


class SimulatedSpeaker:
    """Every member of `interfaces.audio.AudioPlayer`. `played`: how many samples were played."""

    def __init__(self, clock: Callable[[], float] = clock.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()  # what is played is moved from one list to the other
        self._waiting: list[yarpy.Sound] = []
        self._since: float | None = None
        self._gain = 1.0
        self.played = 0

    def play(self, sound: yarpy.Sound) -> None:
        """Put it behind the others."""
        with self._lock:
            if self._count() + sound.length > KEPT:
                raise Refused(f"more than {KEPT} samples wait to be played")
            self._waiting.append(sound)

    def start(self) -> None:
        """Begin."""
        with self._lock:
            if self._since is None:
                self._since = self._clock()

    def stop(self) -> None:
        """Stop."""
        with self._lock:
            self._advance()
            self._since = None

    def clear(self) -> None:
        """Forget what waits."""
        with self._lock:
            self._waiting = []

    def amplify(self, gain: float) -> None:
        """Multiply by this."""
        if gain < 0:
            raise Refused(f"a gain is not negative: {gain}")
        self._gain = gain

    amplify_output = amplify

    def status(self) -> AudioStatus:
        """Return how it is."""
        with self._lock:
            self._advance()
            return AudioStatus(self._since is not None, self._count(), KEPT)

    def _count(self) -> int:
        return sum(sound.length for sound in self._waiting)

    def _advance(self) -> None:
        """Play the sounds whose time has come."""
        if self._since is None:
            return
        while self._waiting:
            first = self._waiting[0]
            end = self._since + first.length / max(first.frequency, 1)
            if end > self._clock():
                return
            self._since = end
            self.played += first.length
            del self._waiting[0]
        self._since = self._clock()
