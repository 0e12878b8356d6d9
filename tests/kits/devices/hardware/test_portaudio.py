"""Microphone and loudspeaker as devices, with the real PortAudio on a sound card made of files."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest
from support.alsa import played, silent_card, sound_card
from support.wait import wait_until

import yarpy
from yarpy import Property
from yarpy.kits.devices import AudioPlayer, AudioRecorder
from yarpy.kits.devices.hardware import portaudio
from yarpy.kits.devices.hardware.portaudio import Loudspeaker, Microphone, player, recorder
from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.wrapper import server_of
from yarpy.nameserver.local import LocalNames


class Speaker:
    """Takes what is played, in the shape of `hardware.audio`."""

    def __init__(self) -> None:
        self.heard: list[int] = []
        self.broken = False
        self.closed = False

    def play(self, sound: yarpy.Sound) -> None:
        if self.broken:
            raise OSError("the loudspeaker plays no more: unplugged")
        self.heard += sound.array[0].tolist()

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def speaker(monkeypatch: pytest.MonkeyPatch) -> Speaker:
    found = Speaker()
    monkeypatch.setattr(portaudio, "Speaker", lambda: found)
    return found


@pytest.fixture
def heard(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """What the microphone hears: while it is 0, nothing; a counter, `heard[0]` pieces more."""
    left = [1]

    def record(rate: int, channels: int, seconds: float) -> Iterator[yarpy.Sound]:
        start = 0
        while left[0] >= 0:
            if left[0]:
                left[0] -= 1
                ramp = np.arange(start, start + 100)
                start += 100
                yield yarpy.Sound([ramp] * channels, rate)
            else:
                yield yarpy.Sound(np.zeros((channels, 0), "i2"), rate)
        raise OSError("the microphone hears no more: unplugged")

    monkeypatch.setattr(portaudio, "record", record)
    return left


def test_a_microphone(heard: list[int]) -> None:
    with Microphone(1000, 2) as found:
        assert not found.recording()
        found.start()
        heard[0] = 2
        sound = found.sound(200, 150, 10.0)
        assert (sound.channels, sound.frequency) == (2, 1000)
        assert sound.array[1].tolist() == [*range(100, 250)], "the first piece was before it began"
        assert found.buffer_size().samples == found.status().current == 50
        assert found.sound(0, 1000).array[0].tolist() == [*range(250, 300)]
        assert found.sound(1, 1000, 0.0).length == 0
        found.amplify(0.5)
        heard[0] = 1
        assert found.sound(100, 100, 10.0).array[0][10] == 155
        found.stop()
        assert found.status().enabled is False
        with pytest.raises(Refused, match="not negative"):
            found.amplify(-1.0)
        with pytest.raises(NotImplementedError, match="the mixer"):
            found.amplify_input(1.0)


def test_the_oldest_is_forgotten(heard: list[int]) -> None:
    with Microphone(50) as found:  # 500 samples are kept
        found.start()
        heard[0] = 7
        wait_until(lambda: not heard[0] and found.status().current == 500)
        assert found.buffer_limit().samples == 500
        assert found.sound(0, 1).array[0][0] == 300
        found.clear()
        assert found.buffer_size().samples == 0


def test_a_microphone_that_is_unplugged(heard: list[int], caplog: pytest.LogCaptureFixture) -> None:
    with Microphone() as found:
        found.start()
        heard[0] = -1
        wait_until(lambda: not found.recording())
    assert "hears no more" in caplog.text


def test_a_loudspeaker(speaker: Speaker) -> None:
    with Loudspeaker() as found:
        found.play(yarpy.Sound(np.arange(1000), 8000))
        assert found.status().current == 1000
        found.clear()
        found.play(yarpy.Sound(np.arange(1000), 8000))
        found.amplify(2.0)
        assert not speaker.heard
        found.start()
        wait_until(lambda: speaker.heard == [*range(0, 2000, 2)])
        assert found.status().enabled
        found.stop()
        found.play(yarpy.Sound(np.zeros(80000, "i2"), 8000))
        with pytest.raises(Refused, match="wait to be played"):
            found.play(yarpy.Sound([1], 8000))
    assert speaker.closed


def test_a_loudspeaker_that_is_unplugged(
    speaker: Speaker, caplog: pytest.LogCaptureFixture
) -> None:
    speaker.broken = True
    with Loudspeaker() as found:
        found.start()
        found.play(yarpy.Sound(np.arange(1000), 8000))
        wait_until(lambda: "plays no more" in caplog.text)
        wait_until(lambda: not found.status().current)


def test_on_ports(heard: list[int], speaker: Speaker, names: LocalNames) -> None:
    microphone, loudspeaker = recorder(Property(rate=8000, start=1)), player(Property())
    assert isinstance(microphone, Microphone)
    assert isinstance(loudspeaker, Loudspeaker)
    assert server_of(microphone) == "audioRecorder_nws_yarp"
    assert server_of(loudspeaker) == "AudioPlayerWrapper"
    with (
        microphone,
        loudspeaker,
        AudioRecorder.serve("/mic", microphone, names=names),
        AudioPlayer.serve("/speaker", loudspeaker, names=names),
        AudioRecorder.connect("/mic", names=names) as client,
        yarpy.Port("/out", names=names) as out,
        yarpy.RpcClient("/speaker/rpc:i", names=names) as asker,
    ):
        assert client.recording()
        heard[0] = 1
        assert client.sound(100, 100, 10.0).length == 100
        asker.ask("start")
        out.connect("/speaker/audio:i")
        out.write(yarpy.Sound([1, 2, 3], 8000))
        wait_until(lambda: speaker.heard == [1, 2, 3])


def run(code: str, environment: Mapping[str, str]) -> str:
    """What a program prints; PortAudio looks at its environment once."""
    head = "import numpy as np\nimport yarpy\nfrom yarpy.kits.devices.hardware.portaudio import *\n"
    done = subprocess.run(
        [sys.executable, "-c", head + code],
        capture_output=True, text=True, timeout=50, env=dict(environment),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.peer("portaudio")
def test_a_sound_card(tmp_path: Path) -> None:
    code = """
import threading, time
from yarpy.kits.devices.hardware import portaudio
card, gate = portaudio.record, threading.Semaphore(0)

def record(*arguments):  # the card has no clock, and would be at its end before it is asked
    for sound in card(*arguments):
        yield sound
        gate.acquire()

portaudio.record = record
with Microphone(8000, 2) as microphone:
    microphone.start()
    gate.release(3)
    sound = microphone.sound(800, 800, 20.0)
    print(sound.length, sound.array[:, :2].tolist(), sound.array[:, -1].tolist())
    gate.release(9)
with Loudspeaker() as loudspeaker:
    loudspeaker.start()
    loudspeaker.play(yarpy.Sound(np.arange(1000), 8000))
    while loudspeaker.status().current:
        time.sleep(0.01)
"""
    assert run(code, sound_card(tmp_path, np.arange(30000))) == (
        "800 [[800, 802], [801, 803]] [2398, 2399]\n"
    )
    assert played(tmp_path)[:1000].tolist() == [*range(1000)]


@pytest.mark.peer("portaudio")
def test_a_machine_without_audio(tmp_path: Path) -> None:
    code = "try:\n    Microphone()\nexcept OSError as error:\n    print(error)"
    assert run(code, silent_card(tmp_path)) == "this machine has no audio device for that\n"


def test_parameters_that_are_wrong() -> None:
    with pytest.raises(ValueError, match="rate fast and channels 1"):
        recorder(Property(rate="fast"))
