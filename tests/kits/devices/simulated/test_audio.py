"""A simulated microphone and loudspeaker, at a clock of the test."""

import pytest

import yarpy
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.audio import KEPT, RATE, SimulatedMicrophone, SimulatedSpeaker


class Clock:
    def __init__(self) -> None:
        self.now = 10.0

    def __call__(self) -> float:
        return self.now


def test_microphone() -> None:
    clock = Clock()
    microphone = SimulatedMicrophone(clock)
    assert not microphone.recording() and microphone.sound().length == 0
    microphone.start()
    clock.now += 0.5
    assert microphone.buffer_size().samples == RATE // 2
    assert microphone.sound(0, 100).length == 100
    first = microphone.sound(0, KEPT)
    assert first.length == RATE // 2 - 100 and abs(first.array).max() == 8000
    microphone.amplify(2.0)
    clock.now += 0.25
    microphone.stop()
    clock.now += 1.0
    assert microphone.status().current == RATE // 4 and not microphone.status().enabled
    assert abs(microphone.sound(0, KEPT).array).max() == 16000
    assert microphone.sound().length == 0
    microphone.start()
    clock.now += 100.0
    assert microphone.buffer_size().samples == KEPT == microphone.buffer_limit().samples
    microphone.clear()
    assert microphone.buffer_size().samples == 0
    with pytest.raises(Refused):
        microphone.amplify(-1.0)


def test_speaker() -> None:
    clock = Clock()
    speaker = SimulatedSpeaker(clock)
    speaker.play(yarpy.Sound([0] * 8000, 16000))
    speaker.play(yarpy.Sound([0] * 16000, 16000))
    clock.now += 10.0
    assert speaker.status().current == 24000 and not speaker.status().enabled
    speaker.start()
    clock.now += 0.75
    assert speaker.status().current == 16000 and speaker.played == 8000
    clock.now += 1.0
    assert speaker.status().current == 0 and speaker.played == 24000
    speaker.play(yarpy.Sound([0] * 8000, 16000))
    speaker.clear()
    speaker.stop()
    assert speaker.status().current == 0
    with pytest.raises(Refused):
        speaker.play(yarpy.Sound([0] * (KEPT + 1)))
    with pytest.raises(Refused):
        speaker.amplify(-1.0)
