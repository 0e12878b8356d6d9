"""Files of applications in TOML: the same as yarpmanager's XML, shorter.

    name = "demo"
    connections = ["/talker -> /listener fast_tcp"]

    [programs.talker]
    command = "yarpy write /talker"

    [programs.listener]
    command = "yarpy read /listener"
    needs = ["/talker"]
    restart = "always"

Rules: pure. A word that means nothing is a problem with its place, as in XML; so is a value of
another kind. `applications` are other files, XML or TOML, by the path from this one.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.kits.launch.application.application import (
    RESTARTS,
    Application,
    Connection,
    Module,
    Need,
    split_words,
)
from yarpy.kits.launch.application.manager_file import Document, Nested, node_name
from yarpy.kits.launch.application.toml_place import Places
from yarpy.kits.launch.application.variable import expand
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.element import BadFile, decoded
from yarpy.kits.launch.document.problem import Problem, Where
from yarpy.limit import APPLICATION_FILE

_ROOT: Final = (
    *("name", "description", "version", "authors", "variables", "needs", "programs"),
    *("connections", "applications"),
)
_PROGRAM: Final = (
    *("command", "node", "prefix", "workdir", "stdio", "environment", "needs", "after", "delay"),
    *("rest", "restart"),
)
_CONNECTION: Final = ("from", "to", "carrier", "id", "external", "persist", "qos")
_NEED: Final = ("port", "timeout", "request", "reply")
_NESTED: Final = ("file", "prefix")
_AT: Final = re.compile(r"(.*) \(at line (\d+), column (\d+)\)", re.DOTALL)
_AT_END: Final = " (at end of document)"
_ARROW: Final = re.compile(r"(\S+)\s*->\s*(\S+)(?:\s+(\S+))?")


def read(
    data: bytes,
    file: str,
    environment: Mapping[str, str],
    variables: Mapping[str, str] | None = None,
) -> Document:
    """Return what a file says; `variables` are those of the one that it is nested in.
    Raises BadFile for one that is no TOML."""
    if len(data) > APPLICATION_FILE:
        raise BadFile(Where(file), f"the file has more than {APPLICATION_FILE} bytes")
    text = decoded(data, file, "utf-8")
    try:
        told = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        said, line, column = _told(str(error), text)
        raise BadFile(Where(file, line, column), f"this is no TOML: {said}") from None
    except RecursionError:
        raise BadFile(Where(file), "this is no TOML: brackets are too many deep") from None
    return _Reading(text, file, environment, variables or {}).document(told)


def _told(said: str, text: str) -> tuple[str, int, int]:
    """Return what Python's parser says, and the line and column that are in it."""
    if found := _AT.fullmatch(said):
        return found[1], int(found[2]), int(found[3])
    if said.endswith(_AT_END):
        lines = text.split("\n")
        return said.removesuffix(_AT_END) + " before the end", len(lines), len(lines[-1]) + 1
    return said, 0, 0


class _Reading:
    def __init__(
        self,
        text: str,
        file: str,
        environment: Mapping[str, str],
        variables: Mapping[str, str],
    ) -> None:
        self._places = Places(text, file)
        self._place = self._places.of
        self.file = file
        self.environment = environment
        self.variables = dict(variables)
        self.found = Application(files=[file])

    def document(self, told: dict[str, Any]) -> Document:
        found = self.found
        document = Document(found, variables=self.variables)
        self._known(told, _ROOT, "")
        for name, value in self._table(told, "variables", "").items():
            self.variables[name] = self._expanded(
                str(value), partial(self._place, "variables", name)
            )
        found.name = self._text(told, "name", "").replace(" ", "_")
        found.description = self._text(told, "description", "")
        found.version = self._text(told, "version", "")
        found.authors = self._texts(told, "authors", "")
        found.needs = [*self._needs(told, "")]
        for label, program in self._table(told, "programs", "").items():
            table = f"programs.{label}"
            if isinstance(program, str | list):
                program = {"command": program}
            if isinstance(program, dict):
                self._program(label, program, table)
            else:
                self._warn(self._place("programs", label), f'"{label}" is no table', fatal=True)
        for one in self._list(told, "connections", ""):
            self._connection(one)
        for one in self._list(told, "applications", ""):
            entry = {"file": one} if isinstance(one, str) else one
            if isinstance(entry, dict) and isinstance(entry.get("file"), str):
                self._known(entry, _NESTED, "applications")
                prefix = self._text(entry, "prefix", "applications")
                file = self._text(entry, "file", "applications")
                document.nested.append(Nested(file, prefix, self._place("", "applications")))
            else:
                where = self._place("", "applications")
                self._warn(where, 'an application is { file = "x.xml" }', fatal=True)
        if not found.name:
            found.name = re.split(r"[\\/]", self.file)[-1].removesuffix(".toml").replace(" ", "_")
        return document

    def _program(self, label: str, told: dict[str, Any], table: str) -> None:
        self._known(told, _PROGRAM, table)
        command = told.get("command", "")
        if isinstance(command, list):
            words = self._texts(told, "command", table)
        else:
            words = split_words(self._text(told, "command", table))
        where = self._place(table, "")
        if not words:
            self._warn(where, f'the program "{label}" has no command', fatal=True)
            return
        restart = self._text(told, "restart", table)
        if restart and restart not in RESTARTS:
            place = self._place(table, "restart")
            text = f'"{restart}" is none of {", ".join(RESTARTS)}{advice(restart, RESTARTS)}'
            self._warn(place, text, fatal=True)
            restart = ""
        self.found.modules.append(
            Module(
                label=label,
                name=words[0],
                words=words,
                node=node_name(self._text(told, "node", table)),
                prefix=self._text(told, "prefix", table),
                workdir=self._text(told, "workdir", table),
                stdio=self._text(told, "stdio", table),
                environment={
                    name: self._expanded(str(value), partial(self._place, table, "environment"))
                    for name, value in self._table(told, "environment", table).items()
                },
                needs=[*self._needs(told, table)],
                after=self._texts(told, "after", table),
                delay=self._number(told, "delay", table) or 0.0,
                rest=self._number(told, "rest", table) or 0.0,
                restart=restart,
                where=where,
            )
        )

    def _connection(self, told: Any) -> None:
        where = self._place("", "connections")
        if isinstance(told, str):
            where = self._places.spelled(told) or where
            arrow = _ARROW.fullmatch(self._expanded(told, lambda: where).strip())
            if arrow is None:
                self._warn(where, f'"{told}" is no connection: "/a -> /b tcp"', fatal=True)
                return
            told = {"from": arrow[1], "to": arrow[2], "carrier": arrow[3] or ""}
        if not isinstance(told, dict):
            self._warn(where, 'a connection is "/a -> /b tcp" or a table', fatal=True)
            return
        table = "connections"
        self._known(told, _CONNECTION, table)
        source, target = self._text(told, "from", table), self._text(told, "to", table)
        if not (source and target):
            missing = "to" if source else "from"
            self._warn(where, f'a connection without "{missing}" is left out', fatal=True)
            return
        external = told.get("external", False)
        ends = external if isinstance(external, list) else ["from", "to"] if external else []
        qos = self._text(told, "qos", table)
        self.found.connections.append(
            Connection(
                source,
                target,
                self._text(told, "carrier", table),
                self._text(told, "id", table),
                source_external="from" in ends,
                target_external="to" in ends,
                persist=told.get("persist") is True,
                source_qos=qos,
                target_qos=qos,
                where=where,
            )
        )

    def _needs(self, told: dict[str, Any], table: str) -> Iterator[Need]:
        for one in self._list(told, "needs", table):
            where = self._place(table, "needs")
            entry = {"port": one} if isinstance(one, str) else one
            if not (isinstance(entry, dict) and isinstance(entry.get("port"), str)):
                self._warn(where, 'what is needed is "/port" or { port = "/p" }', fatal=True)
                continue
            self._known(entry, _NEED, "needs")
            timeout = self._number(entry, "timeout", "needs")
            port, request, reply = (
                self._text(entry, key, "needs") for key in ("port", "request", "reply")
            )
            yield Need(port, timeout, request, reply, where)

    def _text(self, told: dict[str, Any], key: str, table: str) -> str:
        value = told.get(key, "")
        if isinstance(value, dict | list | bool):
            self._warn(self._place(table, key), f'"{key}" is a text', fatal=True)
            return ""
        return self._expanded(str(value), partial(self._place, table, key))

    def _texts(self, told: dict[str, Any], key: str, table: str) -> list[str]:
        where = partial(self._place, table, key)
        return [self._expanded(str(one), where) for one in self._list(told, key, table)]

    def _list(self, told: dict[str, Any], key: str, table: str) -> list[Any]:
        value = told.get(key, [])
        if isinstance(value, str):
            return [value]
        if not isinstance(value, list):
            self._warn(self._place(table, key), f'"{key}" is a list', fatal=True)
            return []
        return value

    def _table(self, told: dict[str, Any], key: str, table: str) -> dict[str, Any]:
        value = told.get(key, {})
        if not isinstance(value, dict):
            self._warn(self._place(table, key), f'"{key}" is a table', fatal=True)
            return {}
        return value

    def _number(self, told: dict[str, Any], key: str, table: str) -> float | None:
        value = told.get(key)
        if value is None:
            return None
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (number and 0 <= value < 1e9):
            self._warn(self._place(table, key), f'"{key}" is a number of seconds', fatal=True)
            return None
        return float(value)

    def _known(self, told: dict[str, Any], words: tuple[str, ...], table: str) -> None:
        for key in told:
            if key not in words:
                inside = f" in [{table}]" if table else ""
                text = f'"{key}"{inside} is ignored{advice(key, words)}'
                self._warn(self._place(table, key), text)

    def _expanded(self, text: str, where: Callable[[], Where]) -> str:
        """Return a text with its variables; `where` says the place."""
        try:
            text, missing = expand(text, self.variables, self.environment)
        except DecodeError as error:
            raise DecodeError(f"{where()}: {error}") from None
        for spelled in missing:
            if spelled != "$":
                self._warn(where(), f"{spelled} is not defined, and so is empty")
        return text

    def _warn(self, where: Where, text: str, fatal: bool = False) -> None:
        self.found.problems.append(Problem(where, text, fatal))
