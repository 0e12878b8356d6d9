"""The loudspeaker and the microphone of this machine, by the library sounddevice (PortAudio).

Rules: they are opened for the first sound. If something is missing, an OSError says what to
install, or what to do instead.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import yarpy


class Speaker:
    """Plays sounds in order. `instead` says what to do where there is no audio."""

    def __init__(self, instead: str = "") -> None:
        self._library = _library(instead)
        self._instead = instead
        self._stream: Any = None
        self._form = 0, 0

    def play(self, sound: yarpy.Sound) -> None:
        """Play a sound; returns once the device has accepted it, so that there are no gaps."""
        form = sound.frequency, sound.channels
        if self._stream is None or form != self._form:
            self.close()
            self._form = form
            self._stream = _open(self._library.RawOutputStream, *form, self._instead)
        try:
            self._stream.write(sound.array.T.tobytes())
        except self._library.PortAudioError as error:
            raise OSError(f"the loudspeaker plays no more: {error}") from error

    def close(self) -> None:
        """Play accepted sounds to their end."""
        if self._stream is not None:
            self._stream.stop()
            self._stream.close()
            self._stream = None


def record(
    frequency: int, channels: int, seconds: float = 0.1, instead: str = ""
) -> Generator[yarpy.Sound]:
    """Sound from the microphone, endlessly, in pieces of `seconds`."""
    import numpy as np

    library = _library(instead)
    stream = _open(library.RawInputStream, frequency, channels, instead)
    try:
        while True:
            data, _ = stream.read(max(1, round(frequency * seconds)))
            yield yarpy.Sound(np.frombuffer(data, "<i2").reshape(-1, channels).T.copy(), frequency)
    except library.PortAudioError as error:
        raise OSError(f"the microphone hears no more: {error}") from error
    finally:
        stream.stop()
        stream.close()


def _library(instead: str) -> Any:
    try:
        import sounddevice
    except ImportError as error:
        raise OSError(
            f"sound needs the library sounddevice: pip install 'yarpy[audio]'{_or(instead)}"
        ) from error
    except OSError as error:
        raise OSError(
            f"sound needs PortAudio ({error}): apt-get install libportaudio2{_or(instead)}"
        ) from error
    return sounddevice


def _open(kind: Any, frequency: int, channels: int, instead: str) -> Any:
    from sounddevice import PortAudioError

    try:
        stream = kind(samplerate=frequency, channels=channels, dtype="int16")
        stream.start()
    except (PortAudioError, ValueError) as error:
        if "device -1" in str(error):
            raise OSError(f"this machine has no audio device for that{_or(instead)}") from error
        raise OSError(
            f"no audio device takes {channels} channels with {frequency} samples a second "
            f"({error}){_or(instead)}"
        ) from error
    return stream


def _or(instead: str) -> str:
    return f"; or {instead}" if instead else ""
