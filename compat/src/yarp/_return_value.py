"""ReturnValue: how a call of a device of YARP 4 ended; true if well.

Rules: it travels as the status of `yarpy.kits.devices`, in the form of 4.0.
"""

from __future__ import annotations

from typing import Any, Final

import yarpy
from yarp._portable import Portable

_CODES: Final = ("ok", "err1", "err2", "err3", "err4", "err5", "err6", "err7", "miss")


class ReturnValue(Portable):
    """`ReturnValue(True)`, `ReturnValue(ReturnValue.return_code_return_value_error_generic)`."""

    (
        return_code_return_value_ok,
        return_code_return_value_error_generic,
        return_code_return_value_error_not_implemented_by_device,
        return_code_return_value_error_nws_nwc_communication_error,
        return_code_return_value_error_deprecated,
        return_code_return_value_error_method_failed,
        return_code_return_value_error_not_ready,
        return_code_return_value_error_input_out_of_bounds,
        return_code_return_value_uninitialized,
    ) = (yarpy.Vocab(code).code for code in _CODES)

    _code: str

    def __init__(self, code: int | bool | ReturnValue | None = None) -> None:
        if code is None:
            code = self.return_code_return_value_uninitialized
        elif isinstance(code, bool):
            good, bad = (
                self.return_code_return_value_ok,
                self.return_code_return_value_error_generic,
            )
            code = good if code else bad
        self._code = str(yarpy.Vocab.from_code(code)) if isinstance(code, int) else code._code

    def _outgoing(self) -> Any:
        return yarpy.Bottle([yarpy.Vocab(self._code)])

    def _take(self, message: yarpy.Message) -> None:
        from yarpy.kits.devices.status import split

        self._code = split(message.as_(yarpy.Bottle))[0]

    def __bool__(self) -> bool:
        return self._code == "ok"

    def __eq__(self, other: object) -> bool:
        if isinstance(other, bool):
            return bool(self) is other
        return isinstance(other, ReturnValue) and self._code == other._code

    __hash__ = None  # type: ignore[assignment]

    def isEqual(self, other: object) -> bool:
        return self == other

    def toString(self) -> str:
        """`ok`, or what went wrong."""
        from yarpy.kits.devices.status import reason

        return "ok" if self else reason(self._code)

    def __repr__(self) -> str:
        return f"<yarp.ReturnValue {self.toString()}>"
