"""Lines of a program's output, however it writes them.

Rules: pure. A line is text without its end, and never longer than a limit: what is beyond is
counted and left out, so that a gigabyte without a newline costs no memory. Bytes that are no UTF-8
are kept as Python keeps them in names of files.
"""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.limit import OUTPUT_LINE


class Lines:
    """Bytes in, lines out: `feed` as they come, `rest` at the end."""

    __slots__ = ("_held", "_left_out")

    def __init__(self) -> None:
        self._held = bytearray()
        self._left_out = 0

    def feed(self, data: bytes) -> Iterator[str]:
        """Yield the lines that `data` ends."""
        *ended, rest = data.split(b"\n")
        for part in ended:
            self._add(part)
            yield self._take()
        self._add(rest)

    def rest(self) -> Iterator[str]:
        """Yield the last line, if it had no end."""
        if self._held:
            yield self._take()

    def _add(self, part: bytes) -> None:
        room = OUTPUT_LINE - len(self._held)
        self._held += part[:room]
        self._left_out += max(len(part) - room, 0)

    def _take(self) -> str:
        text = self._held.decode("utf-8", "surrogateescape").removesuffix("\r")
        if self._left_out:
            text += f" ... and {self._left_out} bytes more"
        self._held.clear()
        self._left_out = 0
        # What is written over again, such as a bar of progress, is seen as it was in the end.
        return text.rpartition("\r")[2]
