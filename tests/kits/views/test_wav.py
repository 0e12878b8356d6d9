"""WAV files: written as sounds come, read in pieces, of any width; what is none is told."""

from __future__ import annotations

import struct
import subprocess
import wave
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.peer import program

import yarpy
from yarpy.kits.views.wav import WavWriter, interleaved, read_wav

STEREO = yarpy.Sound([[1, 2, 3], [-1, -2, -3]], 8000)


def joined(path: Path, seconds: float = 0.1) -> np.ndarray:
    return np.concatenate([sound.array for sound in read_wav(path, seconds)], axis=1)


def written(path: Path, channels: int, width: int, data: bytes, frequency: int = 8000) -> Path:
    with wave.open(str(path), "wb") as file:
        file.setparams((channels, width, frequency, 0, "NONE", ""))
        file.writeframes(data)
    return path


def test_what_was_written_is_read(tmp_path: Path) -> None:
    path = tmp_path / "x.wav"
    with WavWriter(path) as writer:
        writer.write(STEREO)
        # It is there at once, header and all.
        with wave.open(str(path)) as file:
            assert file.getparams()[:4] == (2, 2, 8000, 3)
        writer.write(yarpy.Sound([[4], [-4]], 8000))
        assert (writer.channels, writer.frequency, writer.length) == (2, 8000, 4)
        assert writer.seconds == 4 / 8000
    assert joined(path).tolist() == [[1, 2, 3, 4], [-1, -2, -3, -4]]
    assert [sound.length for sound in read_wav(path, 0.0003)] == [2, 2]
    assert next(read_wav(path)).frequency == 8000


def test_sounds_that_do_not_fit(tmp_path: Path) -> None:
    with WavWriter(tmp_path / "x.wav") as writer:
        with pytest.raises(ValueError, match="0 channels"):
            writer.write(yarpy.Sound(np.zeros((0, 4), "i2")))
        writer.write(STEREO)
        for other in (yarpy.Sound([1], 8000), yarpy.Sound([[1], [2]], 16000)):
            with pytest.raises(ValueError, match="the file 2 with 8000"):
                writer.write(other)
    assert joined(tmp_path / "x.wav").shape == (2, 3)


def test_a_file_that_is_there_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "x.wav"
    with WavWriter(path):
        assert path.exists()
    assert not path.exists()  # nothing came
    path.write_bytes(b"precious")
    with pytest.raises(FileExistsError):
        WavWriter(path)
    assert path.read_bytes() == b"precious"
    with pytest.raises(FileNotFoundError):
        WavWriter(tmp_path / "nowhere" / "x.wav")


@pytest.mark.parametrize(
    ("width", "data", "expected"),
    [
        (1, bytes([0, 128, 255]), [-32768, 0, 32512]),
        (2, struct.pack("<3h", -32768, 0, 32767), [-32768, 0, 32767]),
        (3, b"\x00\x00\x80\xff\x00\x00\x00\xff\x7f", [-32768, 0, 32767]),
        (4, struct.pack("<3i", -(1 << 31), 65535, 0x7FFF0000), [-32768, 0, 32767]),
    ],
)
def test_widths(tmp_path: Path, width: int, data: bytes, expected: list[int]) -> None:
    path = written(tmp_path / "x.wav", 1, width, data)
    assert joined(path).tolist() == [expected]


def test_a_file_that_was_cut_off(tmp_path: Path) -> None:
    path = written(tmp_path / "x.wav", 2, 2, struct.pack("<6h", 1, 2, 3, 4, 5, 6))
    path.write_bytes(path.read_bytes()[:-3])
    assert joined(path).tolist() == [[1, 3], [2, 4]]


@pytest.mark.parametrize("data", [b"", b"RIFF", b"no wave at all, but long enough for a header..."])
def test_what_is_no_wav(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "x.wav"
    path.write_bytes(data)
    with pytest.raises(ValueError, match="ffmpeg -i"):
        next(read_wav(path))
    with pytest.raises(FileNotFoundError):
        next(read_wav(tmp_path / "none.wav"))


@pytest.mark.peer("ffmpeg")
def test_floating_point_of_ffmpeg_and_the_command_that_is_told(tmp_path: Path) -> None:
    path, new = tmp_path / "f.wav", tmp_path / "new.wav"
    quiet = [program("ffmpeg"), "-nostdin", "-loglevel", "error"]
    tone = [*quiet, "-f", "lavfi", "-i", "sine=frequency=440:sample_rate=8000:duration=1"]
    subprocess.run([*tone, "-c:a", "pcm_f32le", path], check=True, timeout=30)
    with pytest.raises(ValueError, match="-c:a pcm_s16le") as caught:
        next(read_wav(path))
    command = str(caught.value).partition("this makes one: ffmpeg ")[2]
    subprocess.run([*quiet, *command.split()], check=True, timeout=30, cwd=tmp_path)
    samples = joined(new)
    assert samples.shape == (1, 8000)
    assert np.abs(np.fft.rfft(samples[0])).argmax() == 440


@given(st.integers(1, 5), st.lists(st.integers(-32768, 32767), max_size=50))
def test_interleaving(channels: int, values: list[int]) -> None:
    values = values[: len(values) // channels * channels]
    sound = yarpy.Sound(np.array(values, "i2").reshape(channels, -1), 100)
    data = interleaved(sound)
    frames = [values[n :: len(values) // channels] for n in range(len(values) // channels or 0)]
    assert data == b"".join(struct.pack(f"<{channels}h", *frame) for frame in frames)
