"""Many pieces of memory on their way into a file, without one copy of all of them.

    Linux, macOS    many pieces in one system call
    Windows         one: it has a counterpart only for files that are opened for that

Rules: the system may take less; whoever calls goes on where it stopped.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from typing import Final

#: pieces that one call may take
MOST: Final = 1 if sys.platform == "win32" else 512

if sys.platform == "win32":

    def write(file: io.FileIO, pieces: Sequence[memoryview]) -> int:
        """Return how many bytes of the first pieces the system took. Raises OSError."""
        return file.write(pieces[0]) or 0

else:
    import os

    def write(file: io.FileIO, pieces: Sequence[memoryview]) -> int:
        """Return how many bytes of the first pieces the system took. Raises OSError."""
        return os.writev(file.fileno(), pieces[:MOST])
