"""SimulatedSynthesizer, SimulatedTranscription: every letter has a tone, every sound the same text;
fakeSpeechSynthesizer and fakeSpeechTranscription in C++.

Rules: of a text so many letters sound; the rest is refused.
"""

from __future__ import annotations

import yarpy
from yarpy.kits.devices.refusal import Refused
from yarpy.limit import SPOKEN_LETTERS

#: Samples a second, and of a letter.
RATE = 16000
LETTER = 800


class _Speaker:
    """The language that both have."""

    def __init__(self) -> None:
        self._language = "auto"

    def switch_language(self, language: str = "auto") -> None:
        """Keep the value; sounds stay as they are."""
        self._language = language

    def language(self) -> str:
        """Return what was written down."""
        return self._language


class SimulatedSynthesizer(_Speaker):
    """Every member of `interfaces.speech.SpeechSynthesizer`."""

    def __init__(self) -> None:
        super().__init__()
        self._voice = "auto"
        self._speed = self._pitch = 0.0

    def switch_voice(self, voice: str = "auto") -> None:
        """Keep the value; sounds stay as they are."""
        self._voice = voice

    def voice(self) -> str:
        """Return what was written down."""
        return self._voice

    def change_speed(self, speed: float = 0.0) -> None:
        """Keep the value; sounds stay as they are."""
        self._speed = speed

    def speed(self) -> float:
        """Return what was written down."""
        return self._speed

    def change_pitch(self, pitch: float) -> None:
        """Keep the value; sounds stay as they are."""
        self._pitch = pitch

    def pitch(self) -> float:
        """Return what was written down."""
        return self._pitch

    def synthesize(self, text: str) -> yarpy.Sound:
        """Return a tone for each letter."""
        import numpy as np

        if len(text) > SPOKEN_LETTERS:
            raise Refused(f"{len(text)} letters are more than {SPOKEN_LETTERS}")
        time = np.arange(LETTER) / RATE
        tones = [np.sin(2 * np.pi * (200 + ord(each) % 128 * 8) * time) for each in text]
        samples = np.concatenate(tones) if tones else np.zeros(0)
        return yarpy.Sound((samples * 8000).astype("int16"), RATE)


class SimulatedTranscription(_Speaker):
    """Every member of `interfaces.speech.SpeechTranscription`."""

    def transcribe(self, sound: yarpy.Sound) -> tuple[str, float]:
        """Return `hello world`, and how sure that is: of silence not at all."""
        return "hello world", 1.0 if sound.length else 0.0
