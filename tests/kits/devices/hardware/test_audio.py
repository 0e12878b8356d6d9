"""Loudspeaker and microphone, with the real PortAudio on a sound card made of files."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from support.alsa import played, silent_card, sound_card

import yarpy
from yarpy.kits.devices.hardware import audio

HEAD = """
import numpy as np
import yarpy
from yarpy.kits.devices.hardware.audio import Speaker, record
"""


def run(code: str, environment: Mapping[str, str]) -> str:
    """What a program prints; PortAudio looks at its environment once."""
    done = subprocess.run(
        [sys.executable, "-c", HEAD + code],
        capture_output=True, text=True, timeout=50, env=dict(environment),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.peer("portaudio")
def test_sounds_are_played_in_order_and_to_their_end(tmp_path: Path) -> None:
    code = """
speaker = Speaker()
for start in range(0, 8000, 800):
    ramp = np.arange(start, start + 800)
    speaker.play(yarpy.Sound([ramp, -ramp], 16000))
speaker.close()
speaker.close()
"""
    run(code, sound_card(tmp_path))
    left, right = played(tmp_path)[:16000].reshape(-1, 2).T
    assert left.tolist() == list(range(8000))
    assert (right == -left).all()


@pytest.mark.peer("portaudio")
def test_a_sound_of_another_form_opens_the_device_anew(tmp_path: Path) -> None:
    code = """
speaker = Speaker()
speaker.play(yarpy.Sound([1, 2, 3], 8000))
speaker.play(yarpy.Sound([[5, 6], [7, 8]], 16000))
speaker.close()
"""
    run(code, sound_card(tmp_path))  # the file begins anew as well
    assert played(tmp_path)[:4].tolist() == [5, 7, 6, 8]


@pytest.mark.peer("portaudio")
def test_the_microphone(tmp_path: Path) -> None:
    code = """
sounds = record(8000, 2, seconds=0.05)
first, second = next(sounds), next(sounds)
sounds.close()
print(first.channels, first.length, first.frequency)
print(first.array[:, :3].tolist(), second.array[:, :3].tolist())
"""
    out = run(code, sound_card(tmp_path, np.arange(20000)))
    assert out.splitlines() == [
        "2 400 8000",
        "[[0, 2, 4], [1, 3, 5]] [[800, 802, 804], [801, 803, 805]]",
    ]


@pytest.mark.peer("portaudio")
def test_a_machine_without_audio(tmp_path: Path) -> None:
    code = """
for what in (lambda: Speaker("do this").play(yarpy.Sound([1])), lambda: next(record(8000, 1))):
    try:
        what()
    except OSError as error:
        print(error)
"""
    assert run(code, silent_card(tmp_path)).splitlines() == [
        "this machine has no audio device for that; or do this",
        "this machine has no audio device for that",
    ]


@pytest.mark.parametrize(
    ("module", "advice"),
    [
        (None, r"pip install 'yarpy\[audio\]'; or do this$"),
        (
            "raise OSError('PortAudio library not found')",
            "apt-get install libportaudio2; or do this$",
        ),
    ],
)
def test_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str | None, advice: str
) -> None:
    monkeypatch.delitem(sys.modules, "sounddevice", raising=False)
    if module is None:
        monkeypatch.setitem(sys.modules, "sounddevice", None)
    else:
        (tmp_path / "sounddevice.py").write_text(module)
        monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(OSError, match=advice):
        audio.Speaker("do this")
    with pytest.raises(OSError, match=advice):
        next(audio.record(8000, 1, instead="do this"))


@pytest.mark.peer("portaudio")
def test_what_no_device_takes(tmp_path: Path) -> None:
    code = """
try:
    Speaker("do this").play(yarpy.Sound([[1]] * 2000, 8000))
except OSError as error:
    print(error)
"""
    out = run(code, sound_card(tmp_path))
    assert out.startswith("no audio device takes 2000 channels with 8000 samples a second (")
    assert out.endswith("); or do this\n")
    assert yarpy.Sound([1]).frequency == 16000
