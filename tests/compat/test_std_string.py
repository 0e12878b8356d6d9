"""A text that a call changes."""

from __future__ import annotations

import pytest

import yarp


def test_what_it_says() -> None:
    word = yarp.std_string("hello")
    assert word.c_str() == str(word) == "hello" and len(word) == word.size() == 5
    word.assign("")
    assert word.empty() and word == "" and word == yarp.std_string() and word != 0
    assert repr(yarp.std_string("a")) == "yarp.std_string('a')"
    with pytest.raises(TypeError):
        yarp.std_string(7)


def test_where_a_result_goes() -> None:
    voice = yarp.PolyDriver("(device fakeSpeechSynthesizer)")
    view = voice.viewISpeechSynthesizer()
    assert view.setLanguage("it-IT")
    language = yarp.std_string()
    assert view.getLanguage(language) and language.c_str() == "it-IT"
    voice.close()
