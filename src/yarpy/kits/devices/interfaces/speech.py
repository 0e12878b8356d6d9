"""SpeechSynthesizer, SpeechTranscription: text to sound, and sound to text.

Source: ISpeechSynthesizer and ISpeechTranscription of YARP 3.9 to 4.0.
"""

from __future__ import annotations

import yarpy
from yarpy.kits.devices.interfaces.media import SoundOf, Text
from yarpy.kits.devices.network.model import Interface, call, sent, taken


class SpeechSynthesizer(Interface):
    """Somebody who speaks: what is written to `text:i` comes as a sound from `sound:o`."""

    NWS, NWC = "speechSynthesizer_nws_yarp", "speechSynthesizer_nwc_yarp"
    FAKE = "fakeSpeechSynthesizer"
    VIEW = "ISpeechSynthesizer"

    @call("set_language", cpp="setLanguage", boxed=True)
    def switch_language(self, language: str = "auto") -> None:
        """Speak another language, such as `it-IT`."""

    @call("get_language", cpp="getLanguage")
    def language(self) -> str:
        """Return the language."""
        raise NotImplementedError

    @call("set_voice", cpp="setVoice", boxed=True)
    def switch_voice(self, voice: str = "auto") -> None:
        """Speak with another voice."""

    @call("get_voice", cpp="getVoice")
    def voice(self) -> str:
        """Return the name of the voice."""
        raise NotImplementedError

    @call("set_speed", cpp="setSpeed", boxed=True)
    def change_speed(self, speed: float = 0.0) -> None:
        """Speak faster or slower."""

    @call("get_speed", cpp="getSpeed")
    def speed(self) -> float:
        """Return how fast it speaks."""
        raise NotImplementedError

    @call("set_pitch", cpp="setPitch", boxed=True)
    def change_pitch(self, pitch: float) -> None:
        """Speak higher or lower."""

    @call("get_pitch", cpp="getPitch")
    def pitch(self) -> float:
        """Return how high it speaks."""
        raise NotImplementedError

    @taken("text:i", Text)
    @sent("sound:o")
    @call("synthesize", cpp="synthesize")
    def synthesize(self, text: str) -> SoundOf:
        """Return how a text sounds."""
        raise NotImplementedError


class SpeechTranscription(Interface):
    """Somebody who understands: what comes to `sound:i` goes as text to `text:o`."""

    NWS, NWC = "speechTranscription_nws_yarp", "speechTranscription_nwc_yarp"
    FAKE = "fakeSpeechTranscription"
    VIEW = "ISpeechTranscription"

    @call("set_language", cpp="setLanguage", boxed=True)
    def switch_language(self, language: str = "auto") -> None:
        """Expect another language, such as `it-IT`."""

    @call("get_language", cpp="getLanguage")
    def language(self) -> str:
        """Return the language."""
        raise NotImplementedError

    @taken("sound:i", yarpy.Sound)
    @sent("text:o")
    @call("transcribe", cpp="transcribe")
    def transcribe(self, sound: SoundOf) -> tuple[str, float]:
        """Return what is said, and how sure that is, from 0 to 1."""
        raise NotImplementedError
