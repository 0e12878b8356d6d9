"""`yarpy hear`: into a file, and out of a loudspeaker that is a file."""

from __future__ import annotations

import signal
import wave

import numpy as np
import pytest
from support.alsa import equipped, played, silent_card, sound_card
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.views.verbs.hear import follow, sounds


def ramp(start=0, frequency=8000):
    return yarpy.Sound([np.arange(start, start + 800), -np.arange(start, start + 800)], frequency)


def recorded(path):
    with wave.open(str(path)) as file:
        assert file.getsampwidth() == 2
        data = file.readframes(file.getnframes())
        return np.frombuffer(data, "<i2").reshape(-1, file.getnchannels()).T, file.getframerate()


@pytest.mark.parametrize(
    "form",
    [
        lambda sound: sound,
        lambda sound: sound.to_bottle("3.5"),
        lambda sound: sound.to_bottle("3.10"),
        lambda sound: sound.to_bottle("4.0"),
    ],
    ids=["3.9", "3.5", "3.10", "4.0"],
)
def test_it_is_recorded_as_every_yarp_sends_it(cli, names, tmp_path, form):
    path = tmp_path / "x.wav"
    words = ("--record", str(path), "--name", "/hear/a", "--duration", "0.3")
    with (
        yarpy.Port("/hear/mic", names=names) as mic,
        cli.start("hear", "/hear/mic", *words) as process,
    ):
        assert mic.wait_for_outputs(timeout=HANG)
        for start in (0, 800, 1600):
            mic.write(form(ramp(start)))
        assert process.wait(HANG) == 0
    assert process.stdout == f"{path}: 0.30 s, channels: 2, samples a second: 8000\n"
    samples, frequency = recorded(path)
    assert frequency == 8000
    assert samples[0].tolist() == list(range(2400))
    assert (samples[1] == -samples[0]).all()


def test_until_somebody_ends_it_and_what_is_no_sound(cli, names, tmp_path):
    path = tmp_path / "y.wav"
    with (
        cli.start("hear", "--record", str(path), "--name", "/hear/b") as process,
        yarpy.Port("/hear/odd", names=names) as odd,
    ):
        wait_until(lambda: names.query("/hear/b"))
        odd.connect("/hear/b")
        for _ in range(3):
            odd.write(["no sound"])
        odd.write(ramp(0, frequency=0))
        odd.write(ramp())
        odd.write(ramp(frequency=16000))
        process.wait_line("the sound has 2 channels with 16000", stream="err", timeout=HANG)
        process.signal(signal.SIGINT)
        assert process.wait() == 0
    assert process.stderr.count("is no sound") == 1
    assert process.stdout == f"{path}: 0.10 s, channels: 2, samples a second: 8000\n"
    assert recorded(path)[0].shape == (2, 800)


def test_a_source_that_comes_later(cli, names, tmp_path):
    path = tmp_path / "z.wav"
    words = ("--record", str(path), "--name", "/hear/c", "--duration", "0.1")
    with cli.start("hear", "/hear/late", *words) as process:
        process.wait_line("warning: Waiting for /hear/late", stream="err", timeout=HANG)
        with yarpy.Port("/hear/late", names=names) as late:
            assert late.wait_for_outputs(timeout=HANG)
            late.write(ramp())
            assert process.wait(HANG) == 0
    assert recorded(path)[0].shape == (2, 800)


@pytest.mark.peer("portaudio")
def test_the_loudspeaker(cli, names, tmp_path):
    command = equipped(cli, sound_card(tmp_path))
    with (
        yarpy.Port("/hear/voice", names=names) as voice,
        command.start("hear", "/hear/voice", "--name", "/hear/d", "--duration", "0.5") as process,
    ):
        assert voice.wait_for_outputs(timeout=HANG)
        for start in range(0, 4000, 800):
            voice.write(ramp(start), wait=True)
        assert process.wait(HANG) == 0
    assert process.stdout == ""
    left, right = played(tmp_path)[:8000].reshape(-1, 2).T
    assert left.tolist() == list(range(4000))
    assert (right == -left).all()


@pytest.mark.peer("portaudio")
def test_without_audio_it_says_what_to_do(cli, names, tmp_path):
    command = equipped(cli, silent_card(tmp_path))
    with (
        yarpy.Port("/hear/mute", names=names) as mute,
        command.start("hear", "/hear/mute", "--name", "/hear/e") as process,
    ):
        assert mute.wait_for_outputs(timeout=HANG)
        mute.write(ramp())
        assert process.wait(HANG) == 1
    assert "error: this machine has no audio device for that; or keep it" in process.stderr


def test_a_recording_is_not_replaced(here, names, tmp_path):
    path = tmp_path / "x.wav"
    path.write_text("precious")
    said = here("hear", "--record", str(path), "--name", "/hear/f")
    assert (said.code, said.out) == (1, "")
    assert f"File exists: {path}" in said.err
    assert path.read_text() == "precious"


def test_what_would_be_late_is_left_out(capsys):
    class Queue(list):
        """Messages as a port gives them, of which ever fewer wait."""

        @property
        def waiting(self):
            return len(self)

        def read(self, timeout):
            if not self:
                raise yarpy.PortClosed("all were read")
            return self.pop(0)

    def messages():
        payloads = [b"".join(map(bytes, ramp(n).to_wire())) for n in range(20)]
        return Queue(yarpy.Message("D", payload) for payload in payloads)

    found = [sound.array[0, 0] for sound in sounds(messages(), late=0.5)]
    assert found == list(range(14, 20))  # 0.1 s each
    assert "14 messages were left out" in capsys.readouterr().err
    assert len(list(sounds(messages(), late=None))) == 20


def test_follow(capsys):
    def take(sound):
        if sound.length == 3:
            raise ValueError("not this one")
        taken.append(sound.length)

    taken = []
    given = (yarpy.Sound(np.zeros(n, "i2"), 10) for n in range(1, 9))
    assert follow(given, take, None) == pytest.approx(3.3)
    assert taken == [1, 2, 4, 5, 6, 7, 8]
    assert capsys.readouterr().err == "error: not this one\n"
    given = (yarpy.Sound(np.zeros(n, "i2"), 10) for n in (5, 5, 5))
    assert follow(given, take, 0.6) == 1.0


def test_silence_ends(capsys):
    names = yarpy.LocalNames()
    with (
        yarpy.BufferedPort("/hear/g", names=names, strict=True) as port,
        yarpy.Port("/hear/odd", names=names) as odd,
    ):
        odd.connect("/hear/g")
        odd.write(ramp())
        odd.write(["no sound"])
        wait_until(lambda: port.waiting == 2)
        heard = sounds(port, None, silence=0.2)
        assert next(heard).length == 800
        with pytest.raises(yarpy.Timeout):
            next(heard)
    assert "is no sound" in capsys.readouterr().err


def test_what_never_sounds_is_not_waited_for_without_end(here, names, tmp_path, monkeypatch):
    monkeypatch.setattr("yarpy.kits.views.verbs.hear.LATENESS", 0.0)
    words = ("--record", str(tmp_path / "x.wav"), "--name", "/hear/h", "--duration", "0.1")
    said = here("hear", "/hear/nobody", *words)
    assert said.code == 1
    assert said.err.endswith("error: no sound came for 0.1 s\n")
