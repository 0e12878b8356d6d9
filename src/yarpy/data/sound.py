"""Sound: samples of several channels, as yarp::sig::Sound of YARP 3.x sends them.

    256, 4, 0, samples, 1, channels, 1, bytes per sample, 1, frequency     (ten int32)
    samples of the first channel, of the second ...                        (int16)

Rules: the 0 is no tag of a Bottle, so a Sound is not one and has no text form. Samples are always
two bytes: what C++ calls 8-bit sound is sent like that too. A received Sound is a view.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any, Self

from yarpy.data.value import BIG
from yarpy.errors import DecodeError, Truncated

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_HEAD = Struct("<10i")


class Sound:
    """int16 samples, shape (channels, n), and how many of them make a second.

    `Sound(samples, frequency=16000)`; samples of one dimension are one channel.
    """

    __slots__ = ("_array", "_data", "channels", "frequency", "length")

    channels: int
    #: samples per channel
    length: int
    #: samples per second of each channel
    frequency: int

    def __init__(self, samples: ArrayLike, frequency: int = 16000) -> None:
        import numpy as np

        given = np.asarray(samples)
        if given.ndim not in (1, 2):
            raise ValueError("the samples of a Sound have the shape (channels, n)")
        if given.size and given.dtype.kind not in "iub":
            raise TypeError(
                f"the samples of a Sound are int16, not {given.dtype}: scale and convert them"
            )
        if given.size and not -0x8000 <= int(given.min()) <= int(given.max()) <= 0x7FFF:
            raise OverflowError("a sample does not fit in 16 bits: scale the sound")
        values = np.atleast_2d(np.ascontiguousarray(given, dtype="<i2"))
        self._array: NDArray[Any] | None = values
        self._data = memoryview(values.data).cast("B") if values.size else memoryview(b"")
        self.channels, self.length = values.shape
        self.frequency = frequency

    @classmethod
    def from_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        """A Sound over the bytes of a message; DecodeError if they are none."""
        if len(view) < _HEAD.size:
            raise Truncated(f"a Sound has a header of {_HEAD.size} bytes", _HEAD.size)
        code, length, zero, samples, *rest = _HEAD.unpack_from(view)
        one, channels, two, _, three, frequency = rest
        if (code, length, zero, one, two, three) != (256, 4, 0, 1, 1, 1):
            raise DecodeError("no Sound: the header is another one")
        if samples < 0 or channels < 0:
            raise DecodeError(f"a Sound of {channels} channels with {samples} samples")
        end = _HEAD.size + 2 * samples * channels
        if len(view) < end:
            raise Truncated(f"this Sound takes {end} bytes, here are {len(view)}", end)
        self = cls.__new__(cls)
        self.channels, self.length, self.frequency = channels, samples, frequency
        self._array = None
        self._data = memoryview(view)[_HEAD.size : end]
        return self

    def to_wire(self) -> tuple[bytes | memoryview, ...]:
        """Header and samples; from 4096 bytes the samples are a block of their own, not copied."""
        head = _HEAD.pack(256, 4, 0, self.length, 1, self.channels, 1, 2, 1, self.frequency)
        if len(self._data) < BIG:
            return (head + self._data,)
        return head, self._data

    @property
    def array(self) -> NDArray[Any]:
        """The samples, int16 of shape (channels, n), over the same memory."""
        if self._array is None:
            import numpy as np

            samples = np.frombuffer(self._data, "<i2")
            self._array = samples.reshape(self.channels, self.length)
        return self._array

    samples = array

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sound):
            return NotImplemented
        mine = (self.channels, self.length, self.frequency, self._data)
        return mine == (other.channels, other.length, other.frequency, other._data)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return (
            f"Sound({self.channels} channels, {self.length} samples, {self.frequency} per second)"
        )
