"""Sounds that are made: makeTone, makeSquareWave, makeSawTooth, mix."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable

from yarp._log import say
from yarp._sound import Sound


def _make(
    sound: Sound,
    wave: Callable[[float], float],
    duration: float,
    channels: int,
    rate: int,
    frequency: float,
    amplitude: int,
) -> bool:
    if duration <= 0 or frequency == 0 or min(channels, rate, amplitude) <= 0:
        say("ERROR", "|yarp.sig.utils| a sound has a duration, channels, a rate and an amplitude")
        return False
    samples = range(int(rate * duration))
    one = array("h", (int(amplitude * wave(each / rate * frequency)) for each in samples))
    sound._channels = [one[:] for _ in range(channels)]
    sound._frequency = rate
    return True


def makeTone(
    outSound: Sound,
    duration_s: float = 1.0,
    channels: int = 1,
    sampleRate: int = 16000,
    frequency: float = 440.0,
    amplitude: int = 30000,
) -> bool:
    """Become a sine wave of so many seconds and hertz."""

    def wave(turns: float) -> float:
        return math.sin(2 * math.pi * turns)

    return _make(outSound, wave, duration_s, channels, sampleRate, frequency, amplitude)


def makeSquareWave(
    outSound: Sound,
    duration_s: float = 1.0,
    channels: int = 1,
    sampleRate: int = 16000,
    frequency: float = 1.0,
    amplitude: int = 30000,
) -> bool:
    """Become a square wave of so many seconds and hertz."""

    def wave(turns: float) -> float:
        return 1.0 if math.sin(2 * math.pi * turns) >= 0 else -1.0

    return _make(outSound, wave, duration_s, channels, sampleRate, frequency, amplitude)


def makeSawTooth(
    outSound: Sound,
    duration_s: float = 1.0,
    channels: int = 1,
    sampleRate: int = 16000,
    frequency: float = 1.0,
    amplitude: int = 30000,
) -> bool:
    """Become a saw tooth of so many seconds and hertz."""

    def wave(turns: float) -> float:
        return 2.0 * (turns - math.floor(turns + 0.5))

    return _make(outSound, wave, duration_s, channels, sampleRate, frequency, amplitude)


def mix(A: Sound, B: Sound, percentage: float) -> Sound:
    """Return both at once: `percentage` of A, from 0 to 1, and the rest of B."""
    made = Sound()
    if A.getFrequency() != B.getFrequency() or A.getChannels() != B.getChannels():
        say("ERROR", "|yarp.sig.utils| sounds that are mixed have the same rate and channels")
        return made
    share = min(max(percentage, 0.0), 1.0)
    length = max(A.getSamples(), B.getSamples())
    made._frequency = A._frequency
    for channel in range(A.getChannels()):
        both = (
            share * A.getSafe(at, channel) + (1 - share) * B.getSafe(at, channel)
            for at in range(length)
        )
        made._channels.append(array("h", map(int, both)))
    return made
