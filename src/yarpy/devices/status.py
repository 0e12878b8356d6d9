"""What devices of YARP 4 say instead of ok, and which of that ours say.

Rules: a Status is a vocab in every answer; the words here are for errors.
"""

from __future__ import annotations

from typing import Final

OK: Final = "ok"
MISSING: Final = "err2"
FAILED: Final = "err5"

_REASONS: Final = {
    "err1": "it failed",
    "err2": "it cannot do this",
    "err3": "it does not reach the device",
    "err4": "it does not do this any more",
    "err5": "it cannot do this, or not with these values",
    "err6": "it is not ready yet",
    "err7": "a value is out of bounds",
    "miss": "it says nothing",
}


def reason(code: str) -> str:
    """What a status that is not ok means."""
    return _REASONS.get(str(code), f"it says {code}")
