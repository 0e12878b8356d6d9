"""Sound: samples of 16 bits in several channels, which ports send.

Rules: it is sent in the form of YARP 3.9, which has no markers; with markers, in that of YARP 4.
"""

from __future__ import annotations

import struct
from array import array
from typing import Any

import yarpy
from yarp._connection import ConnectionReader, Raw
from yarp._log import say
from yarp._numbers import ShortVector, store
from yarp._portable import Portable
from yarp._sound_marker import SoundMarker
from yarp._value import whole

#: How the form of YARP 4 begins: a list of six.
_LIST = 256
_WITH_MARKERS = struct.pack("<2i", _LIST, 6)
#: Where its samples begin.
_BEFORE = 48


def _packed(marker: SoundMarker) -> bytes:
    """Return a marker in the form of YARP 4: a list whose elements have no tags."""
    label = marker.label.encode("utf-8", "surrogateescape")
    text = struct.pack("<i", len(label)) + label
    return (
        struct.pack("<2i", _LIST, 4)
        + text * 2
        + struct.pack("<iq", marker.channel, marker.sample_id)
    )


class Sound(Portable):
    """`Sound()`, then `resize(samples, channels)` and `setFrequency(hertz)`."""

    def __init__(self, bytesPerSample: int | Sound = 2) -> None:
        self._channels: list[array[int]] = []
        self._frequency = 0
        self._markers: dict[str, SoundMarker] = {}
        if isinstance(bytesPerSample, Sound):
            for each in bytesPerSample._markers.values():
                self.add_marker(each.label, each.sample_id, each.channel)
            self._channels = [one[:] for one in bytesPerSample._channels]
            self._frequency = bytesPerSample._frequency

    def _outgoing(self) -> Any:
        import numpy as np

        shape = (self.getChannels(), self.getSamples())
        samples = np.zeros(shape, "<i2")
        for index, one in enumerate(self._channels):
            samples[index] = one
        sound = yarpy.Sound(samples, self._frequency)
        if not self._markers:
            return sound
        head = sound.to_bottle("4.0").to_bytes()
        listed = b"".join(map(_packed, self._markers.values()))
        return Raw(head[:-4] + struct.pack("<i", len(self._markers)) + listed)

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(yarpy.Sound)
        self._channels = [array("h", one.tobytes()) for one in found.array]
        self._frequency = found.frequency
        self._markers.clear()
        data = message.to_bytes()
        if bytes(data[:8]) != _WITH_MARKERS:
            return
        rest = ConnectionReader(yarpy.Message("D", data[_BEFORE + 2 * found.array.size :]))
        count = rest.expectInt32() if rest.expectInt32() == _LIST else 0
        for _ in range(count):
            if (rest.expectInt32(), rest.expectInt32()) != (_LIST, 4):
                break
            rest.expectString()  # its key, which is its label
            label, channel, sample = rest.expectString(), rest.expectInt32(), rest.expectInt64()
            if rest.isError():
                break
            self.add_marker(label, sample, channel)

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
        self._markers.clear()

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
        self._markers.clear()
        return True

    zeroChannel = clearChannel

    # -- markers ------------------------------------------------------------------------------

    def add_marker(self, marker_label: str, sample_id: int, channel: int = -1) -> None:
        """Give a sample a name, in one channel or in all (-1)."""
        marker = SoundMarker()
        marker.label, marker.sample_id, marker.channel = marker_label, sample_id, channel
        self._markers[marker_label] = marker

    def get_marker(self, marker_label: str, sample_id: Any, channel: Any) -> bool:
        """Store where a marker is; False, 0 and -1 if there is none of that name."""
        marker = self._markers.get(marker_label) or SoundMarker()
        store(sample_id, [marker.sample_id])
        store(channel, [marker.channel])
        return marker_label in self._markers

    def getMarkersCount(self) -> int:
        return len(self._markers)

    def getMarker(self, index: int) -> SoundMarker:
        """Return a marker by its number; a blank one if there are fewer."""
        markers = self.getMarkers()
        return markers[index] if 0 <= index < len(markers) else SoundMarker()

    def getMarkers(self) -> list[SoundMarker]:
        return [*self._markers.values()]

    def remove_marker(self, marker_label: str) -> None:
        self._markers.pop(marker_label, None)

    def remove_all_markers(self) -> None:
        self._markers.clear()

    def _marked(self, label: str, default: int) -> int:
        if label in self._markers:
            return self._markers[label].sample_id
        say("WARNING", f"|yarp.sig.Sound| Sound marker not found: {label}")
        return default

    def subSound(self, first_sample: int | str, last_sample: int | str) -> Sound:
        """The samples from one index up to another; from one marker to another, with both."""
        if isinstance(first_sample, str) or isinstance(last_sample, str):
            first_sample = self._marked(str(first_sample), 0)
            last_sample = self._marked(str(last_sample), self.getSamples() - 1) + 1
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
        self._markers.clear()
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
