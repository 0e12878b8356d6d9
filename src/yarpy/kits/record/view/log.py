"""The lines of a log before a moment, as the page of a recording shows them.

Rules: the newest ones are looked for first in a short stretch of time, then in longer ones.
"""

from __future__ import annotations

from collections import deque
from typing import Any, Final

from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.form.line import read_line
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.view.source import rows_of

LINES: Final = 50
TEXT: Final = 1000  # characters of a line
_STRETCHES: Final = (10, 1000)  # seconds that are looked through before all is


def lines_before(recording: Recording, port: str, origin: int, moment: int) -> list[dict[str, Any]]:
    """Return the last LINES lines that came from a port until a moment, the oldest first: `t` in
    seconds from `origin`, `level`, `from` and `text`. Times are nanoseconds since 1970."""
    found: deque[dict[str, Any]] = deque(maxlen=LINES)
    for begin in (*(max(0, moment - seconds * SECOND) for seconds in _STRETCHES), 0):
        found.clear()
        for recorded in rows_of(recording, port, begin, moment + 1):
            line = read_line(recorded.payload, port)
            if line is not None:
                found.append(
                    {
                        "t": (recorded.received_ns - origin) / SECOND,
                        "level": line.level,
                        "from": line.component or line.origin,
                        "text": line.text[:TEXT],
                    }
                )
        if len(found) == LINES:
            break
    return [*found]
