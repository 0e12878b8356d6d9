"""SoundMarker, of YARP 4: a place in a sound with a name."""

from __future__ import annotations


class SoundMarker:
    """`label`, `sample_id`, and `channel`: -1 is all of them."""

    def __init__(self) -> None:
        self.label, self.sample_id, self.channel = "", 0, -1

    def isEqual(self, other: SoundMarker) -> bool:
        return self.__dict__ == other.__dict__
