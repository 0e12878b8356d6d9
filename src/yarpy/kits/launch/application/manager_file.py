"""Files of applications as yarpmanager writes and reads them: XML.

Rules: pure, and exactly what yarpmanager 3.9 takes: which words may be in capitals, of what only
the first counts, how variables are replaced. What it passes over in silence is a problem here, with
its place; so is what it takes although it was hardly meant. `Document` is one file: nested
applications, prefixes and labels come later (`load`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from yarpy.errors import DecodeError
from yarpy.kits.launch.application import vocabulary
from yarpy.kits.launch.application.application import (
    Application,
    Arbitrator,
    Connection,
    Module,
    Need,
)
from yarpy.kits.launch.application.variable import expand
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.document.element import Element, parse
from yarpy.kits.launch.document.problem import Problem, Where

_ANY_CASE: Final = ("module", "connection", "application", "arbitrator")


@dataclass(frozen=True, slots=True)
class Nested:
    """An application in another one, by its name."""

    name: str
    prefix: str
    where: Where


@dataclass(slots=True)
class Document:
    """One file: its own part of the application, and the applications in it."""

    application: Application
    nested: list[Nested] = field(default_factory=list)
    variables: dict[str, str] = field(default_factory=dict)


def read(
    data: bytes,
    file: str,
    environment: Mapping[str, str],
    variables: Mapping[str, str] | None = None,
) -> Document | None:
    """Return what a file says, None if its root is no application; `variables` are those of the
    one that it is nested in. Raises DecodeError."""
    root = parse(data, file)
    if root.tag.lower() != "application":
        return None
    return _Reading(environment, variables or {}).document(root)


class _Reading:
    def __init__(self, environment: Mapping[str, str], variables: Mapping[str, str]) -> None:
        self.environment = environment
        self.variables = dict(variables)
        self.found = Application()

    def document(self, root: Element) -> Document:
        found = self.found
        document = Document(found, variables=self.variables)
        found.files = [root.where.file]
        taken = self._variables(root)
        self._known(root, vocabulary.ROOT, ("prefix",), taken)
        found.name = self._single(root, "name").replace(" ", "_")
        if not found.name:
            self._warn(root.where, "the application has no <name>")
        found.description = self._single(root, "description")
        found.version = self._single(root, "version")
        found.authors = [*self._authors(root)]
        found.needs = [*self._needs(root)]
        readers = {
            "module": self._module,
            "connection": self._connection,
            "arbitrator": self._arbitrator,
        }
        for child in root.children:
            tag = child.tag.lower()
            if tag == "application":
                name = self._single(child, "name").replace(" ", "_")
                self._known(child, vocabulary.NESTED)
                if name:
                    prefix = self._single(child, "prefix")
                    document.nested.append(Nested(name, prefix, child.where))
                else:
                    self._warn(child.where, "the nested application has no <name> and is left out")
            elif tag in readers:
                readers[tag](child)
        return document

    def _variables(self, root: Element) -> set[int]:
        """Take the variables; return which children were taken for one."""
        taken: set[int] = set()
        begun = False
        for child in root.children:
            begun = begun or child.tag == "var"
            if child.tag == "var" and not (child.attributes.get("name") and child.text):
                what = "text" if child.attributes.get("name") else 'attribute "name"'
                self._warn(child.where, f"<var> without {what} is ignored")
            elif begun and child.attributes.get("name") and child.text:
                name = child.attributes["name"]
                self.variables[name] = self._text(child)
                taken.add(id(child))
                if child.tag != "var":
                    self._warn(child.where, f'<{child.tag}> defines the variable "{name}", too')
        return taken

    def _known(
        self,
        element: Element,
        words: tuple[str, ...],
        ignored: tuple[str, ...] = (),
        taken: set[int] | None = None,
    ) -> None:
        """Say which children are ignored."""
        for child in element.children:
            if child.tag in words or child.tag in vocabulary.EDITOR:
                continue
            if child.tag.lower() in words and (
                child.tag.lower() in _ANY_CASE or child.tag.lower() in ("port", "rule", "portmap")
            ):
                continue
            if taken and id(child) in taken:
                continue
            if child.tag in vocabulary.USUAL:
                more = f": {vocabulary.USUAL[child.tag]}"
            elif child.tag in ignored:
                more = ": only that of a nested application counts"
            else:
                more = advice(child.tag, words)
            self._warn(child.where, f"<{child.tag}> in <{element.tag}> is ignored{more}")

    def _module(self, element: Element) -> None:
        self._known(element, vocabulary.MODULE)
        self._attributes(element, ())
        name = self._single(element, "name")
        if not name:
            self._warn(element.where, "a module without <name> is left out", fatal=True)
            return
        starts, stops = self._ensure(element)
        first = next(element.all("dependencies"), None)
        node = self._single(element, "node")
        computer: dict[str, str] = {}
        for child in first.children if first is not None else ():
            if child.tag.lower() == "computer":
                computer |= {one.tag: self._text(one) for one in child.children}
                if not node:
                    self._warn(
                        child.where,
                        f'<computer> chooses none: "{name}" runs on this one, or where <node> says',
                    )
        rank = int(self._number(element, "rank"))
        if rank and not node:
            self._warn(
                next(element.all("rank")).where,
                f'<rank> chooses no computer: "{name}" runs on this one, or where <node> says',
            )
        self.found.modules.append(
            Module(
                label=name,
                name=name,
                parameters=self._single(element, "parameters"),
                node=node_name(node),
                prefix=self._single(element, "prefix"),
                workdir=self._single(element, "workdir"),
                stdio=self._single(element, "stdio"),
                deployer=self._single(element, "deployer"),
                environment=self._environment(element),
                needs=[*self._needs(element)],
                delay=starts,
                rest=stops,
                rank=rank,
                display=self._single(element, "display"),
                computer=computer,
                ports=dict(self._port_map(element)),
                where=element.where,
            )
        )

    def _connection(self, element: Element) -> None:
        self._known(element, vocabulary.CONNECTION)
        self._attributes(element, ("id", "persist", "qos"))
        source = self._end(element, "from", "output")
        target = self._end(element, "to", "input")
        if source is None or target is None or not (source.text and target.text):
            missing = "<from>" if source is None or not source.text else "<to>"
            self._warn(element.where, f"a connection without {missing} is left out", fatal=True)
            return
        both = element.attributes.get("qos", "")
        self.found.connections.append(
            Connection(
                source=self._text(source),
                target=self._text(target),
                carrier=self._single(element, "protocol"),
                id=element.attributes.get("id", ""),
                source_external=_true(source, "external"),
                target_external=_true(target, "external"),
                persist=_true(element, "persist"),
                source_qos=source.attributes.get("qos", both),
                target_qos=target.attributes.get("qos", both),
                where=element.where,
            )
        )

    def _end(self, element: Element, *tags: str) -> Element | None:
        for tag in tags:
            if (found := next(element.all(tag), None)) is not None:
                self._attributes(found, ("external", "qos"))
                return found
        return None

    def _arbitrator(self, element: Element) -> None:
        self._known(element, vocabulary.ARBITRATOR)
        port = next((one for one in element.children if one.tag.lower() == "port"), None)
        rules = {
            one.attributes.get("connection", ""): self._text(one)
            for one in element.children
            if one.tag.lower() == "rule"
        }
        if port is None or not port.text:
            self._warn(element.where, "an arbitrator without <port> is ignored")
            return
        self.found.arbitrators.append(Arbitrator(self._text(port), rules, element.where))

    def _authors(self, root: Element) -> Iterator[str]:
        for child in next((one.children for one in root.all("authors")), []):
            if child.tag.lower() == "author":
                yield self._text(child)
            else:
                more = advice(child.tag, ("author",))
                self._warn(child.where, f"<{child.tag}> in <authors> is ignored{more}")

    def _needs(self, element: Element) -> Iterator[Need]:
        first = next(element.all("dependencies"), None)
        for child in first.children if first is not None else ():
            if child.tag.lower() == "port":
                self._attributes(child, ("timeout", "request", "reply"))
                if child.text:
                    yield Need(
                        self._text(child),
                        self._seconds(child, child.attributes.get("timeout")),
                        child.attributes.get("request", ""),
                        child.attributes.get("reply", ""),
                        child.where,
                    )
            elif child.tag.lower() != "computer":
                more = advice(child.tag, ("port", "computer"))
                self._warn(child.where, f"<{child.tag}> in <dependencies> is ignored{more}")

    def _ensure(self, element: Element) -> tuple[float, float]:
        found = {"start": 0.0, "stop": 0.0}
        first = next(element.all("ensure"), None)
        for child in first.children if first is not None else ():
            when = child.attributes.get("when", "start").lower()
            if child.tag.lower() != "wait":
                more = advice(child.tag, ("wait",))
                self._warn(child.where, f"<{child.tag}> in <ensure> is ignored{more}")
            elif when not in found:
                more = advice(when, ("start", "stop"))
                self._warn(child.where, f'<wait when="{when}"> is ignored{more}')
            else:
                self._attributes(child, ("when",))
                found[when] = self._seconds(child, self._text(child)) or 0.0
        return found["start"], found["stop"]

    def _port_map(self, element: Element) -> Iterator[tuple[str, str]]:
        for child in element.children:
            if child.tag.lower() == "portmap":
                self._known(child, ("old", "new"))
                yield self._single(child, "old"), self._single(child, "new")

    def _environment(self, element: Element) -> dict[str, str]:
        found: dict[str, str] = {}
        for setting in self._single(element, "environment").split(";"):
            name, equals, value = setting.strip().partition("=")
            if equals and name.strip():
                found[name.strip()] = value
            elif name:
                where = next(element.all("environment")).where
                self._warn(where, f'"{name}" is no setting of the environment: NAME=value;OTHER=x')
        return found

    def _single(self, element: Element, tag: str) -> str:
        """Return the text of the first child that is called so."""
        first: Element | None = None
        for child in element.all(tag):
            if first is None:
                first = child
            else:
                self._warn(child.where, f"<{tag}> is ignored: the first one counts")
        if first is None:
            return ""
        for inner in first.children:
            self._warn(inner.where, f"<{inner.tag}> in <{tag}> is ignored")
        return self._text(first)

    def _number(self, element: Element, tag: str) -> float:
        child = next(element.all(tag), None)
        return 0.0 if child is None else self._seconds(child, self._single(element, tag)) or 0.0

    def _seconds(self, element: Element, text: str | None) -> float | None:
        if text is None or not text.strip():
            return None
        try:
            number = float(text)
        except ValueError:
            number = -1.0
        if not 0 <= number < 1e9:
            self._warn(element.where, f'"{text}" in <{element.tag}> is no number', fatal=True)
            return None
        return number

    def _text(self, element: Element) -> str:
        try:
            text, missing = expand(element.text, self.variables, self.environment)
        except DecodeError as error:
            raise DecodeError(f"{element.where}: {error}") from None
        for spelled in missing:
            if spelled == "$":
                self._warn(element.where, "a $ that begins no ${variable} is left as it is")
                continue
            name = spelled.partition("{")[2].removesuffix("}")
            near = "" if "ENV" in spelled else advice(name, [*self.variables])
            self._warn(element.where, f"{spelled} is not defined (here), and so is empty{near}")
        return text.strip()

    def _attributes(self, element: Element, words: tuple[str, ...]) -> None:
        for name in element.attributes:
            if name not in words:
                more = advice(name, words)
                text = f'the attribute "{name}" of <{element.tag}> is ignored{more}'
                self._warn(element.where, text)

    def _warn(self, where: Where, text: str, fatal: bool = False) -> None:
        self.found.problems.append(Problem(where, text, fatal))


def _true(element: Element, name: str) -> bool:
    return element.attributes.get(name, "").lower() == "true"


def node_name(text: str) -> str:
    """Return where a module runs: "" for here, else the name of a server's port."""
    if text in ("", "localhost", "/localhost"):
        return ""
    return text if text.startswith("/") else f"/{text}"
