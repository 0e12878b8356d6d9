"""Applications from files: those in others found, prefixes put in front, programs told apart.

Rules: only files are read, nothing is asked of the network. A nested application of XML is found by
its name among the files beside the one that names it, and in the folders `applications` of the
ResourceFinder; one of TOML by its path. What cannot be found, or contains itself, is a problem.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from yarpy.config.resource import base_directories
from yarpy.errors import DecodeError, MissingFile, YarpError
from yarpy.kits.launch.application import manager_file, toml_file
from yarpy.kits.launch.application.application import Application, Connection, Module, circle
from yarpy.kits.launch.application.manager_file import Document, Nested
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.element import parse
from yarpy.kits.launch.document.problem import Problem, Where
from yarpy.limit import (
    APPLICATION_DEPTH,
    APPLICATION_FILE,
    APPLICATION_FILES,
    APPLICATION_PROGRAMS,
)
from yarpy.platform.refusal import reason
from yarpy.route import parse_carrier

_XML = (".xml", ".xml.template")


def load(path: Path, environment: Mapping[str, str] | None = None) -> Application:
    """Return the application of a file, with what is odd in it. Raises DecodeError for a file that
    is none, MissingFile for one that is not there."""
    loading = _Loading(os.environ if environment is None else environment)
    found = loading.whole(path)
    found.problems = [*dict.fromkeys(found.problems)]
    return found


class _Loading:
    def __init__(self, environment: Mapping[str, str]) -> None:
        self.environment = environment
        self.opened = 0
        self._places: dict[Path, dict[str, Path]] = {}

    def whole(self, path: Path) -> Application:
        document = self._read(path)
        if document is None:
            raise DecodeError(f"{path}: the root of the file is no <application>{_meant(path)}")
        result = document.application
        modules, connections = [*_prefixed(result, "")], [*_connections(result, "")]
        for part in self._parts(document, path, "", [_identity(path)], result):
            modules += part.modules
            connections += part.connections
            result.needs += part.needs
            result.arbitrators += part.arbitrators
            result.problems += part.problems
            result.files += part.files
            if len(modules) > APPLICATION_PROGRAMS:
                raise DecodeError(f"{path}: more than {APPLICATION_PROGRAMS} programs")
        result.modules, result.connections = [*_labelled(modules)], connections
        _check(result)
        return result

    def _parts(
        self, document: Document, path: Path, prefix: str, stack: Sequence[Path], top: Application
    ) -> Iterator[Application]:
        for nested in document.nested:
            file = self._find(nested, path)
            problem = ""
            if file is None:
                problem = f'no file beside this one has the application "{nested.name}"'
                problem += advice(nested.name, [*self._beside(path)])
            elif _identity(file) in stack:
                problem = f'the application "{nested.name}" contains itself'
            elif len(stack) > APPLICATION_DEPTH:
                problem = f"applications are more than {APPLICATION_DEPTH} deep"
            if problem or file is None:
                top.problems.append(Problem(nested.where, problem, fatal=True))
                continue
            inner = self._read(file, document.variables)
            if inner is None:
                text = f'the root of "{file}" is no <application>'
                top.problems.append(Problem(nested.where, text, fatal=True))
                continue
            part, whole = inner.application, prefix + nested.prefix
            part.modules, part.connections = (
                [*_prefixed(part, whole)],
                [*_connections(part, whole)],
            )
            yield part
            yield from self._parts(inner, file, whole, [*stack, _identity(file)], top)

    def _read(self, path: Path, variables: Mapping[str, str] | None = None) -> Document | None:
        self.opened += 1
        if self.opened > APPLICATION_FILES:
            raise DecodeError(f"{path}: more than {APPLICATION_FILES} files in one application")
        data = content(path)
        if path.suffix.lower() == ".toml":
            return toml_file.read(data, str(path), self.environment, variables)
        return manager_file.read(data, str(path), self.environment, variables)

    def _find(self, nested: Nested, path: Path) -> Path | None:
        if path.suffix.lower() == ".toml":
            file = path.parent / nested.name
            return file if file.is_file() else None
        folders = [path.parent, *(one / "applications" for one in base_directories(os.environ))]
        for folder in folders:
            if (found := self._named(folder).get(nested.name)) is not None:
                return found
        return None

    def _beside(self, path: Path) -> dict[str, Path]:
        return {} if path.suffix.lower() == ".toml" else self._named(path.parent)

    def _named(self, folder: Path) -> dict[str, Path]:
        """Return the applications of a folder by name; what cannot be read is none."""
        if folder not in self._places:
            found: dict[str, Path] = {}
            try:
                files = sorted(folder.iterdir())
            except OSError:
                files = []
            for file in [one for one in files if one.name.lower().endswith(_XML) and one.is_file()][
                :APPLICATION_FILES
            ]:
                try:
                    document = manager_file.read(content(file), str(file), self.environment)
                except (YarpError, OSError):
                    continue
                if document is not None and document.application.name:
                    found.setdefault(document.application.name, file)
            self._places[folder] = found
        return self._places[folder]


def content(path: Path) -> bytes:
    """Return the bytes of a file, of one that is too large only some. Raises MissingFile."""
    try:
        with open(path, "rb") as file:
            return file.read(APPLICATION_FILE + 1)
    except OSError as error:
        raise MissingFile(f'"{path}" cannot be read: {reason(error)}') from None


def _identity(path: Path) -> Path:
    return path.resolve()


def _prefixed(part: Application, prefix: str) -> Iterator[Module]:
    """Yield the programs, each with the prefix of its ports in its environment."""
    for module in part.modules:
        whole = prefix + module.prefix
        environment = {"YARP_PORT_PREFIX": whole} if whole else {}
        yield replace(module, prefix=whole, environment={**environment, **module.environment})


def _connections(part: Application, prefix: str) -> Iterator[Connection]:
    """Yield the connections, with the prefix before the application's own ports."""
    external = {need.port for need in part.needs}
    for one in part.connections:
        external |= {one.source} if one.source_external else set()
        external |= {one.target} if one.target_external else set()
    for one in part.connections:
        ends = [
            (name if name in external else prefix + name, name in external)
            for name in (one.source, one.target)
        ]
        yield replace(
            one,
            source=ends[0][0],
            target=ends[1][0],
            source_external=ends[0][1],
            target_external=ends[1][1],
        )


def _labelled(modules: Sequence[Module]) -> Iterator[Module]:
    """Yield the programs, each with a name of its own: the second `view` is `view-2`."""
    taken: set[str] = {module.label for module in modules}
    seen: set[str] = set()
    last: dict[str, int] = {}  # numbers of each name: those below are taken for good
    for module in modules:
        name = Path(module.label).name
        label, number = name or module.label, last.get(name, 1)
        if number > 1:
            label = f"{name}-{number}"
        while label in seen or (number > 1 and label in taken):
            number += 1
            label = f"{name}-{number}"
        seen.add(label)
        last[name] = number
        yield replace(module, label=label)


def _check(found: Application) -> None:
    """Add the problems that need the whole, and no network."""
    from yarpy.registry import carriers

    def warn(where: Where, text: str, fatal: bool = False) -> None:
        found.problems.append(Problem(where, text, fatal))

    if not found.modules and not found.connections and not found.fatal:
        warn(Where(found.files[0]), "there are no programs and no connections in it", True)
    labels = [module.label for module in found.modules]
    for module in found.modules:
        for other in module.after:
            if other not in labels:
                more = advice(other, labels)
                warn(module.where, f'"{other}", after which it starts, is no program{more}', True)
    if around := circle(found.modules):
        where = next(one.where for one in found.modules if one.label == around[0])
        warn(where, f"these wait for each other: {' -> '.join(around)}", True)
    known: dict[tuple[str, str], Where] = {}
    names = [*carriers.names()]
    for one in found.connections:
        first = known.setdefault((one.source, one.target), one.where)
        if first != one.where:  # a file that is there twice says it twice
            warn(one.where, f"{one.label} is connected twice")
        for end in (one.source, one.target):
            if not end.startswith("/"):
                warn(one.where, f'"{end}" begins with no slash: ports do')
        try:
            base = parse_carrier(one.carrier or "tcp").base
        except YarpError as error:
            warn(one.where, str(error))
            continue
        if base not in names:
            warn(one.where, f'no carrier is called "{base}" here{advice(base, names)}')


def _meant(path: Path) -> str:
    """Return what a file with another root is for, or may have meant."""
    tag = parse(content(path), str(path)).tag
    if tag == "robot":
        return f": it is a robot, which `yarpy robot {path}` starts"
    return advice(tag, ["application"])
