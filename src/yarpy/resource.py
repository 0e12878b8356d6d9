"""ResourceFinder: the options and files that a program is configured with.

    finder = ResourceFinder(sys.argv[1:], context="lab", file="tracker.ini")
    finder.find("rate", 30)          # --rate 50, else `rate 50` in tracker.ini, else 30
    finder.file("camera.xml")        # where it is found, or None

Rules (checked against C++ YARP): `--from FILE` names another
configuration file, `--context CONTEXT` another context. What the command line says wins over the
file, and the file over `defaults`. A configuration file that was asked for has to be there; one
that a program names as its usual one need not. Files are searched as `yarpy.config.resource` says,
nothing is cached, and nothing is printed.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from yarpy.config.command_line import parse_options
from yarpy.config.ini import read_ini
from yarpy.config.resource import Search, context_home, robot_home
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.errors import MissingFile
from yarpy.log import logger
from yarpy.platform.refusal import reason

log = logger("yarpy.resource")


class ResourceFinder:
    """Options and files of a program.

    arguments: a command line without the program's name, for example `sys.argv[1:]`.
    context, file: where to look and what to read unless `--context` and `--from` say otherwise.
    defaults: values of options that neither the command line nor the file gives.
    environment, directory: instead of those of this process.
    Raises MissingFile when the file named by `--from` is nowhere or cannot be read.
    """

    #: all options by name
    values: Property
    #: the configuration file that was read, if any
    path: Path | None

    def __init__(
        self,
        arguments: Iterable[str] = (),
        *,
        context: str = "",
        file: str = "",
        defaults: Mapping[str, Any] | None = None,
        environment: Mapping[str, str] | None = None,
        directory: Path | None = None,
    ) -> None:
        given = parse_options(arguments)
        chosen = plain_text(given["context"]) if given.get("context") is not None else context
        self._search = Search(
            os.environ if environment is None else environment,
            Path() if directory is None else directory,
            (chosen,) if chosen else (),
        )
        asked = plain_text(given["from"]) if given.get("from") is not None else ""
        self.values = Property(defaults or {})
        self.path = self._find_configuration(asked, file)
        if self.path is not None:
            if self.path == self._search.directory / (asked or file):
                self._search = replace(self._search, near=self.path.parent)
            self.values.update(self._read(self.path, given, bool(asked)))
        self.values.update(given)
        self._search = replace(self._search, values=self.values)

    @property
    def contexts(self) -> list[str]:
        """The contexts in which files are looked for, in order of preference."""
        return [*self._search.contexts]

    def find(self, key: str, default: Any = None) -> Any:
        """The value of an option, or `default`. An option without a value (`--verbose`) is None."""
        return self.values.get(key, default)

    def check(self, key: str) -> bool:
        """Return whether the option is given, with or without a value."""
        return key in self.values

    def group(self, key: str) -> Bottle | None:
        """The list `(key value ...)`; a section of the file is one, `(section (key value) ...)`."""
        return self.values.group(key)

    def section(self, key: str) -> ResourceFinder:
        """The options of a section, which finds the same files."""
        inner = ResourceFinder.__new__(ResourceFinder)
        inner.values = Property.from_bottle(self.group(key) or ())
        inner.path = self.path
        inner._search = replace(self._search, values=inner.values)
        return inner

    def file(self, name: str) -> Path | None:
        """Return the path of the file called `name`, or named by the option `name`, if it is
        found."""
        return self._search.find(name)

    def files(self, name: str) -> list[Path]:
        """Every file of that name, the preferred one first."""
        return self._search.find_all(name)

    def directory(self, name: str) -> Path | None:
        """Return the path of the directory called `name`, or named by the option `name`, if it is
        found."""
        return self._search.find_directory(name)

    def home(self, context: str = "") -> Path:
        """Return the folder for files of this user in the program's context; it is not created
        here."""
        found = context or next(iter(self._search.contexts), "")
        return context_home(self._search.environment, found)

    def robot_home(self) -> Path:
        """Return the folder for files of this user for the robot; it is not created here."""
        return robot_home(self._search.environment, self._search.robot)

    def __repr__(self) -> str:
        return f"<ResourceFinder {self.path or 'without a file'}: {self.values.to_text()}>"

    def _find_configuration(self, asked: str, usual: str) -> Path | None:
        for name in filter(None, (asked, usual)):
            search = self._search
            found = search.find(name) or search.find_directory(name)
            if found is None and asked:
                looked = ", ".join(str(path.parent) for path in search.candidates(name))
                raise MissingFile(
                    f'"{asked}" (--from) is nowhere; looked in {looked}: give its full path, or '
                    "another --context"
                )
            if found is None:
                log.info('"%s" is nowhere: going on without a configuration file', usual)
            return found
        return None

    def _read(self, path: Path, given: Property, asked: bool) -> Property:
        def find(name: str, context: str) -> Path | None:
            return replace(self._search, contexts=(context,) if context else ()).find(name)

        try:
            return read_ini(path, self._search.environment, given, find)
        except OSError as error:
            if asked:
                raise MissingFile(f"cannot read {path} (--from): {reason(error)}") from error
            log.warning("cannot read %s: %s", path, reason(error))
            return Property()
