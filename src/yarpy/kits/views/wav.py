"""WAV files: written as sound arrives, read in pieces.

Rules: a file has 16 bits per sample. When reading, other widths are converted; compressed and
floating point files are refused, with the command that converts them. Written sound is in the file
immediately, even if the program dies.
"""

from __future__ import annotations

import wave
from collections.abc import Iterator
from pathlib import Path
from typing import Self

import yarpy


class WavWriter:
    """A new file at `path`, which begins with the first sound. Raises OSError, also where there is
    a file already: recordings are not replaced."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.channels = 0
        self.frequency = 0
        self.length = 0  # samples of each channel
        self._raw = open(self.path, "xb")  # noqa: SIM115 - here, so that a wrong path is told now
        self._file: wave.Wave_write | None = None

    @property
    def seconds(self) -> float:
        """The length of the sound, seconds."""
        return self.length / self.frequency if self.frequency else 0.0

    def write(self, sound: yarpy.Sound) -> None:
        """Append a sound. ValueError if it has other channels or another frequency than the first,
        or is none that a file can hold."""
        if self._file is None:
            if not (0 < sound.channels < 1 << 16 and 0 < sound.frequency < 1 << 31):
                raise ValueError(
                    f"a sound of {sound.channels} channels with {sound.frequency} samples a second"
                )
            self.channels, self.frequency = sound.channels, sound.frequency
            self._file = wave.Wave_write(self._raw)
            self._file.setparams((sound.channels, 2, sound.frequency, 0, "NONE", ""))
        elif (sound.channels, sound.frequency) != (self.channels, self.frequency):
            raise ValueError(
                f"the sound has {sound.channels} channels with {sound.frequency} samples a second, "
                f"the file {self.channels} with {self.frequency}"
            )
        self._file.writeframes(interleaved(sound))
        self._raw.flush()
        self.length += sound.length

    def close(self) -> None:
        """End the file; one without any sound is removed."""
        if self._file is not None:
            self._file.close()
        self._raw.close()
        if self._file is None:
            self.path.unlink(missing_ok=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()


def read_wav(path: str | Path, seconds: float = 0.1) -> Iterator[yarpy.Sound]:
    """The sound of a file in pieces of `seconds`. Raises OSError, ValueError."""
    with open(path, "rb") as raw:
        try:
            file = wave.Wave_read(raw)
        except (wave.Error, EOFError) as error:
            raise ValueError(
                f"{path} is no WAV file of plain samples ({str(error) or 'it is too short'}); "
                f"this makes one: ffmpeg -i {path} -c:a pcm_s16le new.wav"
            ) from error
        channels, width, frequency = file.getnchannels(), file.getsampwidth(), file.getframerate()
        if not 0 < width <= 4 or not channels or not frequency:
            raise ValueError(f"{path} has {channels} channels of {width} bytes, {frequency} Hz")
        while data := file.readframes(max(1, round(frequency * seconds))):
            yield _sound(data, channels, width, frequency)


def interleaved(sound: yarpy.Sound) -> bytes:
    """The samples as files and devices want them: one of each channel, then the next of each."""
    return sound.array.T.tobytes()


def _sound(data: bytes, channels: int, width: int, frequency: int) -> yarpy.Sound:
    import numpy as np

    whole = len(data) - len(data) % (width * channels)  # the last frame may be cut off
    if width == 1:
        samples = (np.frombuffer(data, "u1", whole).astype("<i2") - 128) * 256
    elif width == 2:
        samples = np.frombuffer(data, "<i2", whole // 2)
    else:
        # The two upper bytes are the number; the others are too fine for 16 bits.
        planes = np.frombuffer(data, "u1", whole).reshape(-1, width)
        samples = np.ascontiguousarray(planes[:, -2:]).view("<i2").ravel()
    return yarpy.Sound(np.ascontiguousarray(samples.reshape(-1, channels).T), frequency)
