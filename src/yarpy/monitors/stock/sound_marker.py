"""sound_marker: make the edges of sounds audible and visible, to show how a stream is split.

As in C++ YARP 3: five samples of 32000 follow each channel, and the first sample is -32000. (C++
YARP 4 puts markers into a form of Sound that earlier versions cannot read.) Either end.
"""

from __future__ import annotations

from yarpy.data.sig.sound import Sound
from yarpy.monitors.base import Place
from yarpy.wire.message import Message

_LOUD = 32000


class SoundMarker:
    """Marks both edges of every sound."""

    def __init__(self, place: Place) -> None:
        pass

    def update(self, message: Message) -> Sound:
        import numpy as np

        sound = message.as_(Sound)
        marked = np.pad(sound.array, ((0, 0), (0, 5)), constant_values=_LOUD)
        marked[:, :1] = -_LOUD
        return Sound(marked, sound.frequency)
