"""Texts, states and sizes that devices exchange."""

import pytest

import yarpy
from yarpy.kits.devices.interfaces.media import AudioStatus, Configuration, Text


@pytest.mark.parametrize(
    ("words", "text"), [(["hello world"], "hello world"), (["hello", "you", 2], "hello you 2")]
)
def test_several_words_are_one_text(words: list[object], text: str) -> None:
    assert Text.from_wire(yarpy.Bottle(words).to_bytes()) == Text(text)


def test_status_of_audio() -> None:
    """As audioRecorder_nws_yarp of 3.9.1 was recorded: [ok] 6144 44100."""
    words = yarpy.Bottle.from_text("[ok] 6144 44100")
    assert AudioStatus.from_wire(words.to_bytes()) == AudioStatus(True, 6144, 44100)


def test_configuration_is_that_of_colours() -> None:
    assert Configuration().code == yarpy.Vocab("rgb").code
