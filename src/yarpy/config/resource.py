"""Finding configuration and data files where YARP looks for them.

Rules: a file is the first that exists of

    1. ./NAME
    2. next to the program's configuration file, if that was found in the current directory
    3. robots/ROBOT/NAME           in every base directory
    4. contexts/CONTEXT/NAME       in every base directory, unless 2 applies
    5. NAME                        in every base directory

The base directories are, in order: the user's configuration, the user's data, the system's
configuration, the system's data, and those named by `*.ini` files in `config/path.d` of the
system's data. Nothing is cached and nothing is printed. An absolute name is used as it is.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from yarpy.data.text import plain_text
from yarpy.platform.folders import (
    conf_directory,
    configuration_directories,
    data_directories,
    data_home,
)


@dataclass(frozen=True)
class Search:
    """The places in which files are looked for. The defaults are those of this process without a
    context.

    contexts: in order of preference. robot: "" means `YARP_ROBOT_NAME`, or `default`.
    near: directory of the main configuration file, if it was found in `directory` (case 2).
    values: options; one with the same name as the file gives the name to look for instead.
    """

    environment: Mapping[str, str] = field(default_factory=lambda: os.environ)
    directory: Path = field(default_factory=Path)
    contexts: Sequence[str] = ()
    robot: str = ""
    near: Path | None = None
    values: Mapping[str, object] = field(default_factory=dict)

    def find(self, name: str) -> Path | None:
        """The file called `name`, or None."""
        # Every port looks for files that hardly anybody has: paths are made for those that exist.
        return next((Path(path) for path in self._texts(name) if os.path.isfile(path)), None)

    def find_directory(self, name: str) -> Path | None:
        """The directory called `name`, or None."""
        return next((path for path in self.candidates(name) if path.is_dir()), None)

    def find_all(self, name: str) -> list[Path]:
        """Every file of that name, the preferred one first."""
        return [path for path in self.candidates(name) if path.is_file()]

    def candidates(self, name: str) -> Iterator[Path]:
        """Return the paths that `name` may have, in order, whether they exist or not."""
        return map(Path, self._texts(name))

    def _texts(self, name: str) -> Iterator[str]:
        value = self.values.get(name)
        if value is not None:
            name = plain_text(value)
        if not name:
            return
        if os.path.isabs(name):
            yield name
            return
        yield os.path.join(self.directory, name)
        if self.near is not None:
            yield os.path.join(self.near, name)
        bases = [os.fspath(base) for base in base_directories(self.environment)]
        robot = self.robot or self.environment.get("YARP_ROBOT_NAME") or "default"
        yield from (os.path.join(base, "robots", robot, name) for base in bases)
        if self.near is None:
            for context in self.contexts:
                yield from (os.path.join(base, "contexts", context, name) for base in bases)
        yield from (os.path.join(base, name) for base in bases)


def find_file(
    name: str,
    environment: Mapping[str, str] | None = None,
    directory: Path | None = None,
    *,
    contexts: Sequence[str] = (),
) -> Path | None:
    """The file called `name` as this process (or the given environment) finds it, or None."""
    search = Search(
        os.environ if environment is None else environment,
        Path() if directory is None else directory,
        contexts,
    )
    return search.find(name)


# --- base directories


def base_directories(environment: Mapping[str, str]) -> list[Path]:
    """Every directory that may hold `robots/`, `contexts/` and plain files, in order."""
    own = [conf_directory(environment), data_home(environment)]
    system = data_directories(environment)
    return [*own, *configuration_directories(environment), *system, *_listed(system)]


def context_home(environment: Mapping[str, str], context: str) -> Path:
    """Return the folder of this user's files of a context; it is not created here."""
    return data_home(environment) / "contexts" / context


def robot_home(environment: Mapping[str, str], robot: str = "") -> Path:
    """Return the folder of this user's files of a robot; it is not created here."""
    robot = robot or environment.get("YARP_ROBOT_NAME") or "default"
    return data_home(environment) / "robots" / robot


def _listed(directories: Sequence[Path]) -> list[Path]:
    """The directories that `[search NAME]` sections of `config/path.d/*.ini` add."""
    files = [
        file
        for directory in directories
        if os.path.isdir(folder := os.path.join(directory, "config", "path.d"))
        for file in sorted(Path(folder).glob("*.ini"))
    ]
    if not files:
        return []
    from yarpy.config.ini import read_ini

    found = []
    for file in files:
        try:
            values = read_ini(file)
        except OSError:
            continue
        for section in (values.group("search") or ())[1:]:
            group = values.group(plain_text(section))
            paths = group.group("path") if group is not None else None
            found += [Path(plain_text(path)) for path in (paths or ())[1:]]
    return found
