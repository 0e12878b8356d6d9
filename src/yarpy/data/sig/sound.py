"""Sound: samples of several channels, as yarp::sig::Sound of YARP 3.9 sends them.

    256, 4, 0, samples, 1, channels, 1, bytes per sample, 1, frequency     (ten int32)
    samples of the first channel, of the second ...                        (int16)

Other versions send Bottles instead; those are read too, and `to_bottle` makes them:

    up to 3.8   256, 2, an image [mo16] with a row of samples for each channel, 257, 1, frequency
    3.10-3.12   256, 5, 1, samples, 1, channels, 1, bytes, 1, frequency, 320, count, the samples
    4.0         256, 6, the same, and a list of markers, which are not kept

Rules: the 0 is not a tag of Bottles, so a Sound is not a Bottle and has no text form. Samples are
always two bytes: what C++ calls 8-bit sound is sent like that too. A received Sound is a view.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any, Self

from yarpy.data.bottle import Bottle
from yarpy.data.pickling import Wired
from yarpy.data.value import BIG, Vocab
from yarpy.errors import DecodeError, Truncated

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_HEAD = Struct("<10i")
_OLD = Struct("<17i")
_OLD_END = Struct("<3i")
_MAT = 0x0074616D
_MO16 = 0x36316F6D
_NEW = Struct("<12i")
_INT16_LIST = 256 + 64
_OLD_START = Struct("<4i").pack(256, 2, 256, 4)


class Sound(Wired):
    """int16 samples, shape (channels, n), and how many of them make a second.

    `Sound(samples, frequency=16000)`; samples of one dimension are one channel.
    """

    __slots__ = ("_array", "_data", "channels", "frequency", "length")

    channels: int
    #: samples per channel
    length: int
    #: samples per second of each channel
    frequency: int

    def __init__(self, samples: ArrayLike = (), frequency: int = 16000) -> None:
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
        """A Sound over the bytes of a message; DecodeError if they are not one."""
        if bytes(view[:16]) == _OLD_START:
            return cls._from_old_wire(view)
        if len(view) < _HEAD.size:
            raise Truncated(f"a Sound has a header of {_HEAD.size} bytes", _HEAD.size)
        code, length, zero, samples, *rest = _HEAD.unpack_from(view)
        if (code, zero) == (256, 1) and length in (5, 6):
            return cls._from_new_wire(view)
        one, channels, two, _, three, frequency = rest
        if (code, length, zero, one, two, three) != (256, 4, 0, 1, 1, 1):
            raise DecodeError("not a Sound: the header is a different one")
        return cls._over(view, _HEAD.size, channels, samples, frequency)

    @classmethod
    def _from_old_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        if len(view) < _OLD.size:
            raise Truncated(f"an old Sound has a header of {_OLD.size} bytes", _OLD.size)
        head = _OLD.unpack_from(view)
        size, samples, channels = head[11], head[13], head[14]
        image = (9, _MAT, 9, _MO16, 257, 5, 2)
        if head[4:11] != image or head[15:] != (12, size) or size != 2 * samples * channels:
            raise DecodeError(
                "not a Sound: the first of two lists is not an image of 16-bit samples"
            )
        end = _OLD.size + max(size, 0) + _OLD_END.size
        if len(view) < end:
            raise Truncated(f"this Sound takes {end} bytes, here are {len(view)}", end)
        code, count, frequency = _OLD_END.unpack_from(view, end - _OLD_END.size)
        if (code, count) != (257, 1):
            raise DecodeError("not a Sound: the second list is not a frequency")
        return cls._over(view, _OLD.size, channels, samples, frequency)

    @classmethod
    def _from_new_wire(cls, view: bytes | bytearray | memoryview) -> Self:
        if len(view) < _NEW.size:
            raise Truncated(f"a Sound of YARP 3.10 has a header of {_NEW.size} bytes", _NEW.size)
        _, _, _, samples, *rest = _NEW.unpack_from(view)
        one, channels, two, _, three, frequency, tag, count = rest
        if (one, two, three, tag) != (1, 1, 1, _INT16_LIST) or count != samples * channels:
            raise DecodeError("not a Sound: the list does not have the header of samples")
        return cls._over(view, _NEW.size, channels, samples, frequency)

    @classmethod
    def _over(
        cls,
        view: bytes | bytearray | memoryview,
        start: int,
        channels: int,
        samples: int,
        frequency: int,
    ) -> Self:
        """A Sound whose samples begin at `start` of a message."""
        if samples < 0 or channels < 0:
            raise DecodeError(f"a Sound of {channels} channels with {samples} samples")
        end = start + 2 * samples * channels
        if len(view) < end:
            raise Truncated(f"this Sound takes {end} bytes, here are {len(view)}", end)
        self = cls.__new__(cls)
        self.channels, self.length, self.frequency = channels, samples, frequency
        self._array = None
        self._data = memoryview(view)[start:end]
        return self

    def to_bottle(self, version: str = "3.5") -> Bottle:
        """The form for peers of YARP "3.5" (or older), "3.10" or "4.0", to be written unchanged:
        `port.write(sound.to_bottle())`."""
        if version not in ("3.5", "3.10", "4.0"):
            raise ValueError(f'a Sound as a Bottle is for "3.5", "3.10" or "4.0", not {version!r}')
        if version != "3.5":
            from yarpy.data.sig.vector import Vector

            samples = Vector(self.array.ravel(), dtype="int16")
            head = [self.length, self.channels, 2, self.frequency, samples]
            return Bottle(head if version == "3.10" else [*head, []])
        size = len(self._data)
        image = [Vocab("mat"), Vocab("mo16"), [2, size, 2, self.length, self.channels]]
        return Bottle([[*image, bytes(self._data)], [self.frequency]])

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
