"""The spelling of answers for whoever does not tell its own: as YARP 3 does, or 4.

Rules: a port of C++ cannot be asked while it waits for the answer. The name server of yarpy has
asked it before (`nameserver/versions.py`), and says it of its name. Beside the name server of C++
YARP 4 all that do not tell are of it; it is asked for that once in the life of a program. Who is
not known is of YARP 3, as are ports of yarpy, which read both. Who asks with floats of its own is
answered as it spells them, whatever this says (`link/receive/receiver.py`).
"""

from __future__ import annotations

import time
from typing import Final

from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.port.connect import probe

PROPERTY: Final = "yarp"
YARP4: Final = "4"
TIMEOUT: Final = 0.5  # seconds; a question is waiting for its answer meanwhile
AGAIN: Final = 10.0  # seconds until a name server is asked again that did not answer in time

_known: Final[dict[tuple[str, int], bool]] = {}
_silent: Final[dict[tuple[str, int], float]] = {}


def is_yarp4(names: NameClient | None, source: str) -> bool:
    """Return whether the port that asks, whose name is `source`, is of C++ YARP 4. The call under
    way limits how long that may take."""
    if not isinstance(names, YarpNameClient):
        return False
    where = names.host, names.port
    if where not in _known:
        try:
            _known[where] = probe.introduce(Contact("tcp", "", *where), TIMEOUT).yarp4
        except (YarpError, OSError):
            _known[where] = False
    if _known[where]:
        return True
    if not source.startswith("/") or time.monotonic() < _silent.get(where, 0.0):
        return False
    try:
        return YARP4 in names.get(source, PROPERTY)
    except (YarpError, OSError):
        _silent[where] = time.monotonic() + AGAIN
        return False
