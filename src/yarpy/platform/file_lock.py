"""File locks: an open file that one process alone holds, until it closes it or ends.

    Linux, macOS    flock, of the whole file; others read and write as before
    Windows         one byte far behind the end, where nobody reads or writes

Rules: nobody waits.
"""

from __future__ import annotations

import errno
import os
import sys
from typing import Final

#: where the byte is that Windows locks; SQLite's own are elsewhere
FAR: Final = 0x7FFF_FFF0

if sys.platform == "win32":

    def hold(file: int) -> bool:
        """Return whether we hold an open file now; False: another process does. Raises OSError
        where files cannot be locked."""
        import msvcrt

        place = os.lseek(file, 0, os.SEEK_CUR)
        try:
            os.lseek(file, FAR, os.SEEK_SET)
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        except OSError as error:
            if error.errno not in (errno.EACCES, errno.EDEADLK, 0):  # 0: the C library of wine
                raise
            return False
        finally:
            os.lseek(file, place, os.SEEK_SET)
        return True

else:

    def hold(file: int) -> bool:
        """Return whether we hold an open file now; False: another process does. Raises OSError
        where files cannot be locked."""
        import fcntl

        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True
