"""The reason why the system does not open a file, in words.

    Linux, macOS    as the system says it
    Windows         a folder is "Permission denied" there, as is a file that others keep closed: it
                    is told as what it is

Rules: for errors of files; whoever asks says what he wanted, and of which file.
"""

from __future__ import annotations

import errno
import os
import sys


def reason(error: OSError) -> str:
    """Return why a file could not be opened."""
    if sys.platform == "win32" and isinstance(error, PermissionError):
        name = error.filename
        if isinstance(name, str | bytes | os.PathLike) and os.path.isdir(name):
            return os.strerror(errno.EISDIR)
    return error.strerror or str(error) or type(error).__name__
