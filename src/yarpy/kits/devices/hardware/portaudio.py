"""Microphone, Loudspeaker: those of this machine; portaudioRecorder and portaudioPlayer in C++.

    yarpy dev portaudioRecorder --rate 16000 --channels 1 --start 1 --name /mic
    yarpy dev portaudioPlayer --start 1 --name /speaker

Rules: they have the members of `interfaces.audio`, but for the gains of hardware. They begin
stopped unless `start` says otherwise, as in C++. `KEPT` seconds are kept at most: a microphone
forgets the oldest, a loudspeaker refuses more. The system says which device is meant. Thread-safe.
"""

from __future__ import annotations

import threading
from collections import deque
from contextlib import ExitStack, closing
from typing import Any, Final

import yarpy
from yarpy.data.bottle import Property
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.hardware.audio import Speaker, record
from yarpy.kits.devices.interfaces.media import AudioSize, AudioStatus
from yarpy.kits.devices.refusal import Refused
from yarpy.log import logger
from yarpy.names.base import NameClient

log = logger("yarpy.devices")

KEPT: Final = 10  # seconds
PIECE: Final = 0.05  # seconds that are heard or played at a time
_RATE: Final = 16000
_ENDING: Final = 5.0  # seconds for a thread to end


class Microphone(Closeable):
    """Hears `channels` with `rate` samples a second. Raises OSError: no device, no PortAudio."""

    def __init__(self, rate: int = _RATE, channels: int = 1) -> None:
        self._rate, self._channels, self._most = rate, channels, KEPT * rate
        self._changed = threading.Condition()  # guards the ones below
        self._pieces: deque[yarpy.Sound] = deque()
        self._kept = 0
        self._on = self._over = False
        self._gain = 1.0
        self._sounds = record(rate, channels, PIECE)
        next(self._sounds)  # it is there
        with ExitStack() as resources:
            thread = threading.Thread(target=self._run, name="yarpy device microphone", daemon=True)
            thread.start()
            resources.callback(thread.join, _ENDING)
            resources.callback(self._end)
            self._resources = resources.pop_all()

    def start(self) -> None:
        """Begin."""
        self._on = True

    def stop(self) -> None:
        """Stop; what was recorded is kept."""
        self._on = False

    def recording(self) -> bool:
        """Return whether it records."""
        return self._on

    def sound(self, least: int = 0, most: int = 11250, timeout: float = 1.0) -> yarpy.Sound:
        """Return what was recorded, at most `most` samples; wait for `least` so many seconds."""
        import numpy as np

        with self._changed:
            self._changed.wait_for(lambda: self._kept >= least or self._over, timeout)
            wanted = min(max(most, 0), self._kept)
            found: list[Any] = [np.zeros((self._channels, 0), "i2")]
            while wanted:
                piece = self._pieces.popleft()
                if piece.length > wanted:
                    rest = piece.array[:, wanted:]
                    self._pieces.appendleft(yarpy.Sound(rest, self._rate))
                found.append(piece.array[:, :wanted])
                self._kept -= found[-1].shape[1]
                wanted -= found[-1].shape[1]
            return yarpy.Sound(np.concatenate(found, axis=1), self._rate)

    def clear(self) -> None:
        """Forget it."""
        with self._changed:
            self._pieces.clear()
            self._kept = 0

    def amplify(self, gain: float) -> None:
        """Multiply by this."""
        self._gain = _positive(gain)

    def amplify_input(self, gain: float) -> None:
        """Raises NotImplementedError: that gain is the system's."""
        raise NotImplementedError("the mixer of the system has the gain of the card")

    def buffer_size(self) -> AudioSize:
        """Return how much is recorded."""
        return AudioSize(self._kept, self._channels, 2, self._kept * self._channels)

    def buffer_limit(self) -> AudioSize:
        """Return how much is kept at most."""
        return AudioSize(self._most, self._channels, 2, self._most * self._channels)

    def status(self) -> AudioStatus:
        """Return whether it records, and how much is kept."""
        return AudioStatus(self._on, self._kept, self._most)

    def _run(self) -> None:
        try:
            with closing(self._sounds):
                for sound in self._sounds:
                    if self._over:
                        return
                    if self._on:
                        self._keep(_amplified(sound, self._gain))
        except OSError as error:
            self._on = False
            log.warning("%s", error)

    def _keep(self, sound: yarpy.Sound) -> None:
        with self._changed:
            self._pieces.append(sound)
            self._kept += sound.length
            while self._kept > self._most:
                self._kept -= self._pieces.popleft().length
            self._changed.notify_all()

    def _end(self) -> None:
        with self._changed:
            self._over = True
            self._changed.notify_all()


class Loudspeaker(Closeable):
    """Plays sounds one after the other. Raises OSError: no PortAudio."""

    def __init__(self) -> None:
        self._speaker = Speaker()
        self._changed = threading.Condition()  # guards the ones below
        self._waiting: deque[yarpy.Sound] = deque()
        self._on = self._over = False
        self._gain = 1.0
        with ExitStack() as resources:
            resources.callback(self._speaker.close)
            thread = threading.Thread(target=self._run, name="yarpy device speaker", daemon=True)
            thread.start()
            resources.callback(thread.join, _ENDING)
            resources.callback(self._end)
            self._resources = resources.pop_all()

    def play(self, sound: yarpy.Sound) -> None:
        """Put it behind the others. Raises Refused."""
        seconds = sound.length / max(sound.frequency, 1)
        step = max(1, round(sound.frequency * PIECE))
        with self._changed:
            if self._seconds() + seconds > KEPT:
                raise Refused(f"more than {KEPT} s of sound wait to be played")
            for at in range(0, sound.length, step):
                piece = sound.array[:, at : at + step]
                self._waiting.append(yarpy.Sound(piece, sound.frequency))
            self._changed.notify_all()

    def start(self) -> None:
        """Begin."""
        with self._changed:
            self._on = True
            self._changed.notify_all()

    def stop(self) -> None:
        """Stop; what waits is kept."""
        self._on = False

    def clear(self) -> None:
        """Forget what waits."""
        with self._changed:
            self._waiting.clear()

    def amplify(self, gain: float) -> None:
        """Multiply by this."""
        self._gain = _positive(gain)

    def amplify_output(self, gain: float) -> None:
        """Raises NotImplementedError: that gain is the system's."""
        raise NotImplementedError("the mixer of the system has the gain of the card")

    def status(self) -> AudioStatus:
        """Return whether it plays, and how much is to be played."""
        with self._changed:
            count = sum(sound.length for sound in self._waiting)
            rate = self._waiting[0].frequency if self._waiting else _RATE
            return AudioStatus(self._on, count, KEPT * rate)

    def _seconds(self) -> float:
        return sum(sound.length / max(sound.frequency, 1) for sound in self._waiting)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._over or (self._on and self._waiting))
                if self._over:
                    return
                sound = self._waiting.popleft()
            try:
                self._speaker.play(_amplified(sound, self._gain))
            except OSError as error:
                log.warning("%s", error)
                self.clear()

    def _end(self) -> None:
        with self._changed:
            self._over = True
            self._changed.notify_all()


def recorder(options: Property, *, names: NameClient | None = None) -> object:
    """The microphone of this machine. Raises ValueError, OSError."""
    rate, channels = (options.find(*one) for one in (("rate", _RATE), ("channels", 1)))
    if type(rate) is not int or type(channels) is not int or min(rate, channels) < 1:
        raise ValueError(f"rate {rate} and channels {channels} are numbers of 1 and more")
    return _started(Microphone(rate, channels), options)


def player(options: Property, *, names: NameClient | None = None) -> object:
    """The loudspeaker of this machine. Raises OSError."""
    return _started(Loudspeaker(), options)


def _started(device: Microphone | Loudspeaker, options: Property) -> object:
    if str(options.find("start", False)).lower() not in ("false", "0"):
        device.start()
    return device


def _positive(gain: float) -> float:
    if gain < 0:
        raise Refused(f"a gain is not negative: {gain}")
    return gain


def _amplified(sound: yarpy.Sound, gain: float) -> yarpy.Sound:
    import numpy as np

    if gain == 1.0:
        return sound
    louder = np.clip(np.rint(sound.array * gain), -32768, 32767)
    return yarpy.Sound(louder.astype("int16"), sound.frequency)
