"""soundfilter_resample: channels, gain and rates."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest
from support.monitor import place, received, sent

from yarpy import LocalProtocolError, Sound
from yarpy.errors import DecodeError
from yarpy.monitors.stock.soundfilter_resample import SoundFilterResample

STEREO = Sound(np.array([[100, -200, 30000], [7, 8, -9]]), 16000)


def filtered(sound: Sound, tokens: str) -> Sound:
    return Sound.from_wire(sent(SoundFilterResample, sound, tokens))


def tone(hertz: float, rate: int, channels: int = 1) -> Any:
    wave = 10000 * np.sin(2 * np.pi * hertz * np.arange(rate) / rate)
    return np.repeat(wave[None], channels, axis=0).astype("i2")


@pytest.mark.parametrize(
    ("tokens", "expected"),
    [
        ("", STEREO.array.tolist()),
        ("channel.1", [[7, 8, -9]]),
        ("gain_percent.50", [[50, -100, 15000], [3, 4, -4]]),
        ("channel.0+gain_percent.200", [[200, -400, 32767]]),
        ("channel.0+frequency.16000", [[100, -200, 30000]]),
    ],
)
def test_channel_and_gain(tokens: str, expected: Any) -> None:
    made = filtered(STEREO, tokens)
    assert made.array.tolist() == expected
    assert made.frequency == 16000


@pytest.mark.parametrize("rate", [8000, 44100, 48000])
@pytest.mark.parametrize("channels", [1, 2])
def test_rate(rate: int, channels: int) -> None:
    made = filtered(Sound(tone(440, 16000, channels), 16000), f"frequency.{rate}")
    assert (made.frequency, made.channels) == (rate, channels)
    assert abs(made.length - rate) <= 1
    middle = slice(rate // 10, rate // 2)
    error = made.array[:, middle].astype(int) - tone(440, rate, channels)[:, middle]
    assert np.abs(error).max() < 20  # of 10000


def test_nothing_to_resample() -> None:
    made = filtered(Sound(np.zeros((1, 0), "i2"), 16000), "frequency.8000")
    assert made.length == 0


def test_channel_that_is_not_there() -> None:
    with pytest.raises(DecodeError, match="no channel 2: the sound has 2"):
        filtered(STEREO, "channel.2")


@pytest.mark.parametrize("rate", [0, -5, 1])
def test_announced_rates_take_no_memory(rate: int) -> None:
    data = b"".join(Sound(tone(440, 16000), rate).to_wire())
    with pytest.raises(DecodeError, match="cannot be resampled"):
        received(SoundFilterResample, data, "frequency.1000000", limit=1 << 24)


def test_no_sound() -> None:
    with pytest.raises(DecodeError):
        sent(SoundFilterResample, ["hi"])


@pytest.mark.parametrize("tokens", ["frequency.0", "channel.left", "gain_percent.-1"])
def test_wrong_parameters(tokens: str) -> None:
    with pytest.raises(LocalProtocolError, match=tokens.partition(".")[0]):
        SoundFilterResample(place(tokens))


def test_without_soxr_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "soxr", None)
    with pytest.raises(LocalProtocolError, match=r"yarpy\[sound\]"):
        SoundFilterResample(place("frequency.8000"))
    SoundFilterResample(place("channel.0"))
