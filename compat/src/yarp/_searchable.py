"""Searchable: Bottle, Property, lists in a Value, ResourceFinder, all searched by key.

Rules: a key that is not there gives a null Value or a null Bottle, as in C++; nothing is raised.
"""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._value import MISSING, Value


class SearchReport:
    """Which key was looked for, and what was found or said of it."""

    def __init__(self) -> None:
        self.key = self.value = ""
        self.isFound = self.isGroup = self.isComment = self.isDefault = False


class SearchMonitor:
    """Hears what is looked for (`setMonitor`): subclasses define `report`."""

    def report(self, report: SearchReport, context: str) -> None:
        """Called with each look."""


class Searchable:
    """The common part. Subclasses say what they hold in `_find` and `_group`."""

    def _find(self, key: str) -> Any:
        """The native value of a key, or MISSING."""
        raise NotImplementedError

    def _group(self, key: str) -> yarpy.Bottle | None:
        """The whole list of a key."""
        raise NotImplementedError

    _monitor: SearchMonitor | None = None
    _context = ""

    def find(self, key: str) -> Value:
        """The value of a key."""
        found = Value._of(self._find(key))
        if self._monitor is not None:
            self._tell(key, "" if found.isNull() else found.toString(), isFound=not found.isNull())
        return found

    def findGroup(self, key: str, comment: str = "") -> Any:
        """The list `key value ...` as a Bottle."""
        from yarp._bottle import Bottle

        group = self._group(key)
        if self._monitor is not None:
            if comment:
                self._tell(key, comment, isComment=True)
            text = "" if group is None else group.to_text()
            self._tell(key, text, isFound=group is not None, isGroup=True)
        return Bottle._of(yarpy.Bottle() if group is None else group, is_null=group is None)

    def check(self, key: str, fallback: Value | str = "", comment: str = "") -> Any:
        """Return whether there is such a key; with a Value as second, its value or that."""
        if self._monitor is not None:
            if isinstance(fallback, Value):
                self._tell(key, fallback.toString(), isDefault=True)
            said = comment if isinstance(fallback, Value) else fallback
            if said:
                self._tell(key, said, isComment=True)
            self._tell(key, "", isFound=self._find(key) is not MISSING)
        if isinstance(fallback, Value):
            found = self._find(key)
            return fallback if found is MISSING else Value._of(found)
        return self._find(key) is not MISSING or self._group(key) is not None

    def setMonitor(self, monitor: SearchMonitor | None, context: str = "") -> None:
        """Tell somebody what is looked for from now on; None ends it."""
        self._monitor, self._context = monitor, context

    def getMonitor(self) -> SearchMonitor | None:
        return self._monitor

    def getMonitorContext(self) -> str:
        return self._context

    def reportToMonitor(self, report: SearchReport) -> None:
        """Tell who watches, if somebody does."""
        if self._monitor is not None:
            self._monitor.report(report, self._context)

    def _tell(self, key: str, value: str, **facts: bool) -> None:
        report = SearchReport()
        report.key, report.value = key, value
        for name, fact in facts.items():
            setattr(report, name, fact)
        self.reportToMonitor(report)

    def isNull(self) -> bool:
        """Return whether this stands for something that was not found."""
        return False

    def toString(self) -> str:
        """The text of it all."""
        raise NotImplementedError

    def toString_c(self) -> str:
        """The same as `toString`."""
        return self.toString()
