"""How answers are spelled for whoever does not tell: as the YARP of the name server, 3 or 4.

Rules: a name server is asked once in the life of a program, when that is to be known; one that does
not say in time which YARP it is, is of YARP 3, as are those of yarpy. Who asks with floats of its
own is answered as it spells them, whatever this says (`link/receive/receiver.py`).
"""

from __future__ import annotations

from typing import Final

from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.port.connect import probe

TIMEOUT: Final = 0.5  # seconds; a question is waiting for its answer meanwhile

_known: Final[dict[tuple[str, int], bool]] = {}


def is_yarp4(names: NameClient | None) -> bool:
    """Return whether a name service is the name server of C++ YARP 4."""
    if not isinstance(names, YarpNameClient):
        return False
    where = names.host, names.port
    if where not in _known:
        try:
            _known[where] = probe.introduce(Contact("tcp", "", *where), TIMEOUT).yarp4
        except (YarpError, OSError):
            _known[where] = False
    return _known[where]
