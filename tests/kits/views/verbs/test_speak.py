"""`yarpy speak`: files and the microphone into ports."""

from __future__ import annotations

import time
import wave

import numpy as np
import pytest
from support.alsa import equipped, sound_card
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.views.verbs.speak import LEAD, send


@pytest.fixture
def song(tmp_path):
    """0.35 s of two channels, 8000 samples a second."""
    path = tmp_path / "song.wav"
    with wave.open(str(path), "wb") as file:
        file.setparams((2, 2, 8000, 0, "NONE", ""))
        ramp = np.arange(2800, dtype="<i2")
        file.writeframes(np.stack([ramp, -ramp], 1).tobytes())
    return path


def gathered(port, count):
    """So many messages as sounds, and their stamps."""
    messages = [port.read(timeout=HANG) for _ in range(count)]
    return [message.as_(yarpy.Sound) for message in messages], [m.stamp for m in messages]


@pytest.mark.parametrize("version", [None, "3.5", "3.9", "3.10", "4.0"])
def test_a_file(cli, names, song, version):
    words = ("--yarp", version) if version else ()
    with yarpy.BufferedPort("/speak/ear", strict=True, names=names) as ear:
        done = cli.run("speak", "/speak/ear", "--play", str(song), "--name", "/speak/a", *words)
        assert (done.returncode, done.stdout) == (0, "")
        sounds, stamps = gathered(ear, 4)
    assert [sound.length for sound in sounds] == [800, 800, 800, 400]
    samples = np.concatenate([sound.array for sound in sounds], axis=1)
    assert samples[0].tolist() == list(range(2800))
    assert (samples[1] == -samples[0]).all()
    assert [stamp.count for stamp in stamps] == [0, 1, 2, 3]
    assert all(sound.frequency == 8000 for sound in sounds)


def test_it_waits_for_a_listener(cli, names, song):
    with cli.start("speak", "--play", str(song), "--name", "/speak/b") as process:
        wait_until(lambda: yarpy.exists("/speak/b", names=names))
        with yarpy.BufferedPort("/speak/late", strict=True, names=names) as late:
            late.listen_to("/speak/b")
            assert gathered(late, 4)[0][0].array[0, 1] == 1
            assert process.wait(HANG) == 0


def test_what_one_speaks_another_hears(cli, names, song, tmp_path):
    path = tmp_path / "heard.wav"
    words = ("--record", str(path), "--name", "/speak/hear", "--duration", "0.35")
    with cli.start("hear", *words) as hearing:
        wait_until(lambda: yarpy.exists("/speak/hear", names=names))
        said = cli.run("speak", "/speak/hear", "--play", str(song), "--name", "/speak/c")
        assert said.returncode == 0
        assert hearing.wait(HANG) == 0
    assert path.read_bytes() == song.read_bytes()


@pytest.mark.peer("portaudio")
def test_the_microphone(cli, names, tmp_path):
    command = equipped(cli, sound_card(tmp_path, np.arange(16000)))
    words = ("--name", "/speak/d", "--frequency", "8000", "--channels", "2")
    with (
        yarpy.BufferedPort("/speak/mic", strict=True, names=names) as port,
        command.start("speak", "/speak/mic", *words),
    ):
        sounds, stamps = gathered(port, 3)
    assert [(s.channels, s.length, s.frequency) for s in sounds] == [(2, 800, 8000)] * 3
    assert sounds[1].array[:, :2].tolist() == [[1600, 1602], [1601, 1603]]
    assert stamps[2].count == 2


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("/speak/x", "--play", "/nowhere.wav"), "No such file or directory: /nowhere.wav"),
        (("/speak/x", "--play", __file__), "is no WAV file of plain samples"),
        (("--yarp", "2.0"), "2.0"),
        (("--channels", "0"), "--channels"),
    ],
)
def test_what_cannot_be_sent(here, names, words, error):
    said = here("speak", *words)
    assert (said.code, said.out) == (1, "")
    assert error in said.err
    assert names.query("/speak") is None


def test_nobody_there(here, names, song):
    said = here("speak", "/speak/nobody", "--play", str(song), "--name", "/speak/e")
    assert said.code == 1 and '"/speak/nobody"' in said.err
    assert names.query("/speak/e") is None


def test_an_empty_file(here, tmp_path):
    path = tmp_path / "empty.wav"
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 2, 8000, 0, "NONE", ""))
    said = here("speak", "--play", str(path))
    assert said.code == 1 and "is empty" in said.err


def test_it_is_sent_when_it_is_to_be_heard():
    class Port:
        def write(self, sound, stamp):
            written.append((time.monotonic() - started, stamp.count))

    written = []
    started = time.monotonic()
    send(Port(), [yarpy.Sound(np.zeros(100, "i2"), 1000)] * 6, "3.9", paced=True)
    assert [count for _, count in written] == list(range(6))
    for moment, count in written:
        assert moment >= count * 0.1 - LEAD - 0.001  # never earlier than that
