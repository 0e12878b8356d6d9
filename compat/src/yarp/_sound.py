"""Sound: samples of 16 bits in several channels, which ports send."""

from __future__ import annotations

from array import array
from typing import Any

import yarpy
from yarp._log import say
from yarp._numbers import ShortVector, store
from yarp._portable import Portable
from yarp._value import whole


class Sound(Portable):
    """`Sound()`, then `resize(samples, channels)` and `setFrequency(hertz)`."""

    def __init__(self, bytesPerSample: int | Sound = 2) -> None:
        self._channels: list[array[int]] = []
        self._frequency = 0
        if isinstance(bytesPerSample, Sound):
            self._channels = [one[:] for one in bytesPerSample._channels]
            self._frequency = bytesPerSample._frequency

    def _outgoing(self) -> Any:
        import numpy as np

        shape = (self.getChannels(), self.getSamples())
        samples = np.zeros(shape, "<i2")
        for index, one in enumerate(self._channels):
            samples[index] = one
        return yarpy.Sound(samples, self._frequency)

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(yarpy.Sound)
        self._channels = [array("h", one.tobytes()) for one in found.array]
        self._frequency = found.frequency

    def getSamples(self) -> int:
        """Samples in each channel."""
        return len(self._channels[0]) if self._channels else 0

    def getChannels(self) -> int:
        return len(self._channels)

    def getFrequency(self) -> int:
        """Samples a second."""
        return self._frequency

    def getBytesPerSample(self) -> int:
        return 2

    def getDuration(self) -> float:
        """Seconds."""
        return self.getSamples() / self._frequency if self._frequency else 0.0

    def setFrequency(self, freq: int) -> None:
        self._frequency = freq

    def resize(self, samples: int, channels: int = 1) -> None:
        """So many samples in each channel; all are 0."""
        self._channels = [array("h", bytes(2 * samples)) for _ in range(channels)]

    def set(self, value: int, sample: int, channel: int = 0) -> None:
        """Change a sample."""
        if isinstance(value, float) or not -0x8000 <= value <= 0x7FFF:
            raise TypeError(f"a sample is an integer of 16 bits, not {value!r}")
        self._channels[channel][sample] = whole(value, 16)

    def get(self, sample: int, channel: int = 0) -> int:
        """A sample."""
        return self._channels[channel][sample]

    def isSample(self, sample: int, channel: int = 0) -> bool:
        return 0 <= sample < self.getSamples() and 0 <= channel < self.getChannels()

    def getSafe(self, sample: int, channel: int = 0) -> int:
        """A sample, 0 where there is none."""
        return self.get(sample, channel) if self.isSample(sample, channel) else 0

    def setSafe(self, value: int, sample: int, channel: int = 0) -> None:
        """Change a sample, if it is there."""
        if self.isSample(sample, channel):
            self.set(value, sample, channel)

    def clear(self) -> None:
        """Silence; the size stays, as in YARP before 4."""
        for one in self._channels:
            one[:] = array("h", bytes(2 * len(one)))

    zero = clear

    def clearChannel(self, channel: int) -> bool:
        """Silence one channel."""
        if not 0 <= channel < self.getChannels():
            return False
        self._channels[channel][:] = array("h", bytes(2 * self.getSamples()))
        return True

    def subSound(self, first_sample: int, last_sample: int) -> Sound:
        """The samples from one index up to another."""
        found = Sound()
        found._frequency = self._frequency
        found._channels = [one[first_sample:last_sample] for one in self._channels]
        return found

    def extractChannelAsSound(self, channel_id: int) -> Sound:
        found = Sound()
        found._frequency = self._frequency
        found._channels = [self._channels[channel_id][:]]
        return found

    def replaceChannel(self, id: int, channel: Sound) -> bool:
        """Take the first channel of another sound of this length."""
        if channel.getSamples() != self.getSamples() or not 0 <= id < self.getChannels():
            return False
        self._channels[id] = channel._channels[0][:]
        return True

    def amplify(self, gain: float) -> None:
        """Multiply every sample; what is too large is cut."""
        for channel in range(self.getChannels()):
            self.amplifyChannel(channel, gain)

    def amplifyChannel(self, channel: int, gain: float) -> None:
        one = self._channels[channel]
        for index, value in enumerate(one):
            one[index] = max(-0x8000, min(0x7FFF, int(value * gain)))

    def normalize(self) -> None:
        """As loud as it can be."""
        peak = max((abs(value) for one in self._channels for value in one), default=0)
        if peak:
            self.amplify(0x7FFF / peak)

    def normalizeChannel(self, channel: int) -> None:
        peak = max((abs(value) for value in self._channels[channel]), default=0)
        if peak:
            self.amplifyChannel(channel, 0x7FFF / peak)

    def findPeakInChannel(self, channelId: int, sampleId: Any, sampleValue: Any) -> None:
        """Store where the largest sample of a channel is, and its value."""
        one = self._channels[channelId]
        value = max(one, default=0)
        found = (one.index(value), value) if value > 0 else (0, 0)
        store(sampleId, [found[0]])
        store(sampleValue, [found[1]])

    def findPeak(self, channelId: Any, sampleId: Any, sampleValue: Any) -> None:
        """Store in which channel and where the largest sample is, and its value."""
        largest = [max(one, default=0) for one in self._channels]
        channel = largest.index(max(largest)) if largest else 0
        store(channelId, [channel])
        if largest:
            self.findPeakInChannel(channel, sampleId, sampleValue)

    def getChannel(self, channel_id: int) -> ShortVector:
        """The samples of a channel; a copy, where C++ hands out references."""
        return ShortVector(self._channels[channel_id])

    def getInterleavedAudioRawData(self) -> ShortVector:
        return self.sound2VecInterleaved()

    def getNonInterleavedAudioRawData(self) -> ShortVector:
        return self.sound2VecNonInterleaved()

    def overwrite(self, alt: Sound, offset: int = 0, len: int = 0) -> None:
        """Put another sound, or its first `len` samples, over this one from a sample on."""
        if (alt.getChannels(), alt._frequency) != (self.getChannels(), self._frequency):
            say("ERROR", "|yarp.sig.Sound| both sounds need the same channels and frequency")
            return
        room = max(self.getSamples() - offset, 0)
        count = min(len or alt.getSamples(), alt.getSamples(), room)
        for mine, other in zip(self._channels, alt._channels, strict=True):
            mine[offset : offset + count] = other[:count]

    def sample2timestamp(self, sampleid: int) -> float:
        return sampleid / self._frequency if self._frequency else 0.0

    def timestamp2sample(self, time: float) -> int:
        return int(time * self._frequency)

    def sound2VecInterleaved(self) -> ShortVector:
        """All samples, those of one time side by side."""
        return ShortVector(
            [value for frame in zip(*self._channels, strict=True) for value in frame]
        )

    def sound2VecNonInterleaved(self) -> ShortVector:
        """All samples, one channel after the other."""
        return ShortVector([value for one in self._channels for value in one])

    def vecInterleaved2Sound(self, vec: Any, samples: int, channels: int) -> None:
        """Become these samples."""
        values = [*vec]
        self._channels = [array("h", values[one::channels][:samples]) for one in range(channels)]

    def vecNonInterleaved2Sound(self, vec: Any, samples: int, channels: int) -> None:
        """Become these samples."""
        values = [*vec]
        self._channels = [
            array("h", values[one * samples : (one + 1) * samples]) for one in range(channels)
        ]

    def isEqual(self, alt: Sound) -> bool:
        return self._frequency == alt._frequency and self._channels == alt._channels

    def toString(self) -> str:
        """The samples as text, a line for each channel."""
        lines = ("".join(f" {value}" for value in one) for one in self._channels)
        return "".join(f"{line}\n" for line in lines)

    toString_c = toString
