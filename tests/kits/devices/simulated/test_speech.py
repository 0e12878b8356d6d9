"""A simulated voice and ear, alone and over the network."""

import pytest
from support.wait import wait_until

import yarpy
from yarpy.kits.devices import SpeechSynthesizer, SpeechTranscription
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.speech import (
    LETTER,
    SimulatedSynthesizer,
    SimulatedTranscription,
)
from yarpy.limit import SPOKEN_LETTERS
from yarpy.nameserver.local import LocalNames


def test_what_is_written_down() -> None:
    voice = SimulatedSynthesizer()
    voice.switch_language("it-IT")
    voice.switch_voice("anna")
    voice.change_speed(1.5)
    voice.change_pitch(-0.5)
    assert (voice.language(), voice.voice(), voice.speed(), voice.pitch()) == (
        "it-IT", "anna", 1.5, -0.5,
    )  # fmt: skip
    assert voice.synthesize("").length == 0
    with pytest.raises(Refused):
        voice.synthesize("a" * (SPOKEN_LETTERS + 1))
    assert SimulatedTranscription().transcribe(yarpy.Sound([])) == ("hello world", 0.0)


def test_from_text_to_sound_to_text(names: LocalNames) -> None:
    """What comes to one port goes as a sound to the other device, and as text to us."""
    heard: list[yarpy.Message] = []
    said: list[yarpy.Message] = []
    with (
        SpeechSynthesizer.serve("/voice", SimulatedSynthesizer(), names=names),
        SpeechTranscription.serve("/ear", SimulatedTranscription(), names=names),
        yarpy.BufferedPort("/heard", callback=heard.append, names=names) as hearing,
        yarpy.BufferedPort("/said", callback=said.append, names=names) as reading,
        yarpy.Port("/text", names=names) as text,
        SpeechSynthesizer.connect("/voice", names=names) as voice,
    ):
        hearing.listen_to("/voice/sound:o")
        reading.listen_to("/ear/text:o")
        yarpy.connect("/voice/sound:o", "/ear/sound:i", names=names)
        text.connect("/voice/text:i")

        def arrived() -> bool:
            # Readers are asked for their version before they get anything.
            text.write(yarpy.Bottle(["hi", "you"]))
            return bool(heard and said)

        wait_until(arrived)
        sound = heard[0].as_(yarpy.Sound)
        assert sound.length == LETTER * len("hi you")
        assert said[0].value == ["hello world", 1.0]
        assert voice.synthesize("hi you") == sound
