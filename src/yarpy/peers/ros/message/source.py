"""The sources of the text of a type: folders, packages of ROS, what rosbags brings, and others.

    Source                anything that finds a text by name; `Library` asks several in a row
    Folder                a folder with packages in it, or with files
    Packages              ROS_PACKAGE_PATH, and an installed ROS
    Rosbags               the messages of Noetic that the package rosbags brings (extra `ros`)
    Standard              what yarpy's own types turn into, and the packages used most: always there

Rules: a source returns None for what it has not, and reads nothing that is not called for. Names
are checked before they become paths. A file is read up to a limit.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Final, Protocol

from yarpy.errors import DecodeError
from yarpy.limit import ROS_TEXT
from yarpy.peers.ros.message import shipped, standard

#: how deep packages may lie below a folder of ROS_PACKAGE_PATH, and folders looked at
_MAX_DEPTH: Final = 5
_MAX_FOLDERS: Final = 20_000
_PACKAGE = re.compile(r"<name>\s*+([A-Za-z][A-Za-z0-9_-]*+)\s*+</name>")


class Source(Protocol):
    """Has texts of types; a client of a type server on the network is one too."""

    def find(self, name: str, kind: str) -> str | None:
        """The text of package/Type, `kind` being "msg" or "srv"; None if it is not here."""

    def __str__(self) -> str:
        """Return the place of the source, for people."""


class Folder:
    """A folder with packages in it (`DIR/turtlesim/msg/Pose.msg`), a package itself, or a folder
    with files; the `msg` and `srv` between may be missing."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)

    def find(self, name: str, kind: str) -> str | None:
        package, _, plain = name.partition("/")
        file = f"{plain}.{kind}"
        path = self.path.absolute()
        at = [path / package]
        if package == path.name:
            at.append(path)
        elif path.name in ("msg", "srv") and package == path.parent.name:
            at += [path.parent, path]
        for folder in at:
            for place in (folder / kind / file, folder / file):
                if place.is_file():
                    return read_text(place)
        return None

    def __str__(self) -> str:
        return str(self.path)


class Packages:
    """Packages of ROS: those below the folders of ROS_PACKAGE_PATH, and the installed ones.

    `roots` are searched through for files package.xml; of `shares` only the folders right in them
    count.
    """

    def __init__(self, roots: Sequence[Path] = (), shares: Sequence[Path] = ()) -> None:
        self.roots = roots
        self.shares = shares

    @classmethod
    def of(cls, environment: Mapping[str, str]) -> Packages:
        """Return the packages that a program of ROS with this environment would find."""
        roots = _paths(environment.get("ROS_PACKAGE_PATH", ""))
        prefixes = _paths(environment.get("CMAKE_PREFIX_PATH", ""))
        installed = sorted(Path("/opt/ros").glob("*"), reverse=True)
        shares = [prefix / "share" for prefix in (*prefixes, *installed)]
        return cls(roots, [*shares, Path("/usr/share")])

    def find(self, name: str, kind: str) -> str | None:
        package, _, plain = name.partition("/")
        for folder in self._folders(package):
            place = folder / kind / f"{plain}.{kind}"
            if place.is_file():
                return read_text(place)
        return None

    def _folders(self, package: str) -> Iterator[Path]:
        yield from (root / package for root in self.roots)
        yield from (share / package for share in self.shares)
        yield from self._below_roots.get(package, ())

    @cached_property
    def _below_roots(self) -> dict[str, list[Path]]:
        found: dict[str, list[Path]] = {}
        room = _MAX_FOLDERS
        for root in self.roots:
            start = len(root.parts)
            for folder, folders, files in os.walk(root):
                room -= 1
                if "package.xml" in files:
                    path = Path(folder)
                    found.setdefault(_package_name(path), []).append(path)
                    folders.clear()
                elif "CATKIN_IGNORE" in files or len(Path(folder).parts) - start >= _MAX_DEPTH:
                    folders.clear()
                folders[:] = sorted(name for name in folders if name[0] != ".")
                if room < 0:
                    return found
        return found

    def __str__(self) -> str:
        if not self.roots:
            return "the packages of an installed ROS"
        return f"ROS_PACKAGE_PATH ({os.pathsep.join(map(str, self.roots))})"


class Rosbags:
    """The messages of a distribution that rosbags knows. Their texts have no comments.

    `version`: 1 or 2, of ROS; `store`: what rosbags calls the distribution.
    """

    def __init__(self, version: int = 1, store: str = "ROS1_NOETIC") -> None:
        self._version = version
        self._store_name = store

    def find(self, name: str, kind: str) -> str | None:
        if kind != "msg" or self._store is None:
            return None
        package, _, plain = name.partition("/")
        full = f"{package}/msg/{plain}"
        if full not in self._store.fielddefs:
            return None
        if self._version == 1 and package == "builtin_interfaces":  # rosbags has it for itself
            return None
        text: str = self._store.generate_msgdef(full, ros_version=self._version)[0]
        return text.partition("=" * 80)[0]

    @cached_property
    def _store(self) -> Any:
        try:
            from rosbags.typesys import Stores, get_typestore
        except ImportError:
            return None
        return get_typestore(Stores[self._store_name])

    def found_or_missing(self, found: str) -> str:
        """Return `found` for people to read, or how to install what is missing."""
        if self._store is None:
            extra = "ros" if self._version == 1 else "ros2"
            return f"rosbags, which is not installed (pip install 'yarpy[{extra}]')"
        return found

    def __str__(self) -> str:
        return self.found_or_missing("the types that rosbags brings")


class Standard:
    """The messages that yarpy's own types turn into, and those that programs of ROS use most."""

    messages: Mapping[str, str] = {**shipped.MESSAGES, **standard.MESSAGES}
    services: Mapping[str, str] = {**shipped.SERVICES, **standard.SERVICES}

    def find(self, name: str, kind: str) -> str | None:
        return (self.messages if kind == "msg" else self.services).get(name)

    def __str__(self) -> str:
        return "the types that yarpy brings"


class Texts:
    """Texts by name, as a full definition brings them."""

    def __init__(self, texts: Mapping[str, str], where: str) -> None:
        self.texts = texts
        self.where = where

    def find(self, name: str, kind: str) -> str | None:
        return self.texts.get(name) if kind == "msg" else None

    def __str__(self) -> str:
        return self.where


def read_text(path: Path) -> str:
    """The text of a file, with line ends as ROS sees them; DecodeError if it is too long."""
    with path.open(encoding="utf-8", errors="surrogateescape") as file:
        text = file.read(ROS_TEXT + 1)
    if len(text) > ROS_TEXT:
        raise DecodeError(f"{path}: a definition of more than {ROS_TEXT} characters")
    return text


def _paths(text: str) -> list[Path]:
    return [Path(part) for part in text.split(os.pathsep) if part]


def _package_name(folder: Path) -> str:
    """Return the package's name in package.xml; the name of its folder if there is none."""
    try:
        with (folder / "package.xml").open(encoding="utf-8", errors="replace") as file:
            found = _PACKAGE.search(file.read(1 << 16))
    except OSError:
        found = None
    return found[1] if found else folder.name
