"""ResourceFinder: options and files of a program.

Rules: before `configure` it knows the defaults only. What the command line says wins.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yarpy
from yarp._bottle import Bottle
from yarp._log import say
from yarp._searchable import Searchable
from yarp._value import MISSING, Value, copied, int32, number
from yarpy.platform.folders import (
    conf_directory,
    configuration_directories,
    data_directories,
    data_home,
)


class ResourceFinder(Searchable):
    """`configure(sys.argv)`, then `find`, `check`, `findGroup`, `findFile`."""

    def __init__(self, alt: ResourceFinder | None = None) -> None:
        self._context = ""
        self._file = ""
        self._defaults: dict[str, Any] = {}
        self._finder = yarpy.ResourceFinder()
        self._configured = False
        if alt is not None:
            self.__dict__.update(alt.__dict__)
            self._defaults = dict(alt._defaults)

    def _find(self, key: str) -> Any:
        found = self._finder.values.get(key, MISSING)
        return MISSING if found is None else found

    def _group(self, key: str) -> yarpy.Bottle | None:
        return self._finder.group(key)

    # -- before -------------------------------------------------------------------------------

    def setVerbose(self, verbose: bool = True) -> bool:
        """Tell where files are found: `yarpy resource --verbose` does."""
        return True

    def setQuiet(self, quiet: bool = True) -> bool:
        return True

    def setDefaultContext(self, contextName: str) -> bool:
        """Where to look unless `--context` says otherwise."""
        self._context = contextName
        self._look_again()
        return True

    def setDefaultConfigFile(self, fname: str) -> bool:
        """Set the file to read unless `--from` says otherwise."""
        self._file = fname
        return True

    def setDefault(self, key: str, val: Any) -> bool:
        """The value of an option that is not given."""
        if isinstance(val, Value):
            native = copied(val._native)
        elif isinstance(val, str):
            native = val
        else:
            native = number(val) if isinstance(val, float) else int32(val)
        self._defaults[key] = native
        if key not in self._finder.values:
            self._finder.values[key] = native
        if key == "context":
            self._context = val if isinstance(val, str) else ""
        return True

    def _look_again(self) -> None:
        if not self._configured:
            self._finder = yarpy.ResourceFinder(context=self._context, defaults=self._defaults)

    def configure(self, argc: Any, *more: Any) -> bool:
        """Read the command line, such as `sys.argv`, and the configuration file.

        The length of the command line, or anything else before it, is passed over, as old programs
        say it. False if the file of `--from` is nowhere; the options are there in any case.
        """
        line: Sequence[str] = ()
        skip = True
        for argument in (argc, *more):
            if isinstance(argument, list | tuple):
                line = argument
            elif isinstance(argument, bool):
                skip = argument
        arguments = [*line][1 if skip else 0 :]
        self._configured = True
        asked = ""
        try:
            self._finder = self._made_of(arguments, self._file)
        except yarpy.MissingFile as error:
            say("ERROR", f"|yarp.os.ResourceFinder| {error}")
            # The other options count all the same.
            at = arguments.index("--from")
            asked = arguments[at + 1]
            self._finder = self._made_of([*arguments[:at], *arguments[at + 2 :]], "")
        if self._file and not asked and self._finder.path is None:
            say("ERROR", f"|yarp.os.ResourceFinder| cannot find {self._file}")
        if asked or self._file:
            self._finder.values.setdefault("from", asked or self._file)
        return not asked

    def _made_of(self, arguments: Sequence[str], file: str) -> yarpy.ResourceFinder:
        return yarpy.ResourceFinder(
            arguments, context=self._context, file=file, defaults=self._defaults
        )

    def isConfigured(self) -> bool:
        return self._configured

    # -- files --------------------------------------------------------------------------------

    def findFile(self, name: str) -> str:
        """The path of a file, named by an option or by itself; "" if it is nowhere."""
        return _text(self._finder.file(name))

    findFileByName = findFile

    def findPath(self, name: str = "") -> str:
        """The path of a file or directory; "" if it is nowhere."""
        if not name:
            return _text(self._finder.path.parent if self._finder.path else None)
        return _text(self._finder.file(name) or self._finder.directory(name))

    def findPaths(self, name: str) -> Bottle:
        """Every path of a file."""
        return Bottle._of(yarpy.Bottle(map(_text, self._finder.files(name))))

    def readConfig(self, config: Any, key: str, options: Any = None) -> bool:
        """Read a configuration file into a Property."""
        path = self.findFile(key)
        return bool(path) and bool(config.fromConfigFile(path))

    def findNestedResourceFinder(self, key: str) -> ResourceFinder:
        """The options of a section."""
        inner = ResourceFinder(self)
        inner._finder = self._finder.section(key)
        return inner

    def getContext(self) -> str:
        return next(iter(self._finder.contexts), "")

    def getContexts(self) -> Bottle:
        return Bottle._of(yarpy.Bottle(self._finder.contexts))

    def getHomeContextPath(self) -> str:
        """Where files of this user in this context are kept; made if it is not there."""
        return _made(self._finder.home())

    def getHomeRobotPath(self) -> str:
        """Where files of this user for the robot are kept; made if it is not there."""
        return _made(self._finder.robot_home())

    def toString(self) -> str:
        """The options as text."""
        return self._finder.values.to_text()

    toString_c = toString

    @staticmethod
    def getConfigHome() -> str:
        return _made(conf_directory(os.environ))

    @staticmethod
    def getConfigHomeNoCreate() -> str:
        return str(conf_directory(os.environ))

    @staticmethod
    def getDataHome() -> str:
        return _made(data_home(os.environ))

    @staticmethod
    def getDataHomeNoCreate() -> str:
        return str(data_home(os.environ))

    @staticmethod
    def getConfigDirs() -> Bottle:
        return Bottle._of(yarpy.Bottle(map(str, configuration_directories(os.environ))))

    @staticmethod
    def getDataDirs() -> Bottle:
        return Bottle._of(yarpy.Bottle(map(str, data_directories(os.environ))))

    @staticmethod
    def getResourceFinderSingleton() -> ResourceFinder:
        global _singleton
        if _singleton is None:
            _singleton = ResourceFinder()
        return _singleton


_singleton: ResourceFinder | None = None


def _text(path: Path | None) -> str:
    """A path from the root on, "" for none."""
    return "" if path is None else os.path.abspath(path)


def _made(path: Any) -> str:
    path.mkdir(parents=True, exist_ok=True)
    return str(path)
