"""ArrayExport: what numpy, torch and other libraries take for an array.

Rules: for values with an `array`. Nothing is copied unless the other library asks for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class ArrayExport:
    """The base of values with numbers, for `numpy.asarray` and `torch.from_dlpack`."""

    __slots__ = ()

    @property
    def array(self) -> NDArray[Any]:
        """The numbers as a numpy array."""
        raise NotImplementedError

    def __array__(
        self, dtype: np.dtype[Any] | None = None, copy: bool | None = None
    ) -> NDArray[Any]:
        array = self.array
        if dtype is not None and dtype != array.dtype:
            return array.astype(dtype)
        return array.copy() if copy else array

    def __dlpack__(self, **options: Any) -> Any:
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self) -> tuple[int, int]:
        kind, number = self.array.__dlpack_device__()
        return int(kind), int(number)
