"""Classes of C++ that a program of Python has no use for; see `_refusal`."""

from __future__ import annotations

from yarp._refusal import Absent
from yarp._table import NOT_HERE


class LogStream(Absent, why=NOT_HERE["LogStream"]):
    """Collects what << is given in C++."""
