"""The user that this program runs as.

    Linux, macOS    a number, which files and sockets have, too
    Windows         none: what others may reach is said by folders and by pipes

Rules: one number for a process.
"""

from __future__ import annotations

import os
import sys

if sys.platform == "win32":

    def user() -> int | None:
        """Return the number of our user; None: users have none."""
        return None

else:

    def user() -> int | None:
        """Return the number of our user; None: users have none."""
        return os.geteuid()
