"""An application: programs, what they wait for, and the connections between their ports.

Rules: pure values, whichever file they come from (`manager_file`, `toml_file`). Names of ports have
their prefixes already, variables are replaced, nested applications are part of the one that has
them. Each remembers where it is written.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from yarpy.kits.launch.document.problem import NOWHERE, Problem, Where

RESTARTS: Final = ("no", "on-failure", "always")


@dataclass(frozen=True, slots=True)
class Need:
    """A port that has to be there, and to answer `request` with `reply` if there is a request.
    `timeout`: seconds to wait, None as long as one usually waits, 0 to look once."""

    port: str
    timeout: float | None = None
    request: str = ""
    reply: str = ""
    where: Where = NOWHERE


@dataclass(frozen=True, slots=True)
class Module:
    """A program of an application.

    `label` is unique there; `node` is the server of another computer, "" for here; `after` are the
    labels of those that start first; `delay` and `rest` are seconds before it starts and after it
    has ended; `restart` is one of RESTARTS, "" for what is usual; `words`, if any, are its command
    line as it is.
    """

    label: str
    name: str
    parameters: str = ""
    node: str = ""
    prefix: str = ""
    workdir: str = ""
    stdio: str = ""
    deployer: str = ""
    environment: Mapping[str, str] = field(default_factory=dict)
    needs: Sequence[Need] = ()
    after: Sequence[str] = ()
    delay: float = 0.0
    rest: float = 0.0
    rank: int = 0
    display: str = ""
    computer: Mapping[str, str] = field(default_factory=dict)
    ports: Mapping[str, str] = field(default_factory=dict)
    restart: str = ""
    words: Sequence[str] = ()
    where: Where = NOWHERE

    @property
    def command(self) -> list[str]:
        """The words of its command line: quotes protect blanks."""
        if self.words:
            return [*self.words]
        words = split_words(self.parameters)
        if self.deployer == "yarpdev":
            return ["yarpdev", "--device", self.name, *words]
        if self.deployer:
            return [*split_words(self.deployer), self.name, *words]
        return [*split_words(self.name), *words]


@dataclass(frozen=True, slots=True)
class Connection:
    """Two ports that are to be connected, and to stay so. `carrier` "" is the usual one; an
    external end is not opened by the application; `persist`: the name server keeps it, too."""

    source: str
    target: str
    carrier: str = ""
    id: str = ""
    source_external: bool = False
    target_external: bool = False
    persist: bool = False
    source_qos: str = ""
    target_qos: str = ""
    where: Where = NOWHERE

    @property
    def label(self) -> str:
        """`/a -> /b`."""
        return f"{self.source} -> {self.target}"


@dataclass(frozen=True, slots=True)
class Arbitrator:
    """The rules, by the id of their connection, which the carriers at a port were made from."""

    port: str
    rules: Mapping[str, str] = field(default_factory=dict)
    where: Where = NOWHERE


@dataclass(slots=True)
class Application:
    """All of it, with what is odd in its files; `files` are those that it was read from."""

    name: str = ""
    description: str = ""
    version: str = ""
    authors: list[str] = field(default_factory=list)
    needs: list[Need] = field(default_factory=list)
    modules: list[Module] = field(default_factory=list)
    connections: list[Connection] = field(default_factory=list)
    arbitrators: list[Arbitrator] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    files: list[str] = field(default_factory=list)

    @property
    def fatal(self) -> bool:
        """Return whether it cannot run as it is written."""
        return any(problem.fatal for problem in self.problems)

    @property
    def summary(self) -> str:
        """Its name, and how much of what it has."""
        has = {"program": len(self.modules), "connection": len(self.connections)}
        counts = (f"{many} {what}{'' if many == 1 else 's'}" for what, many in has.items())
        return f"{self.name}: {', '.join(counts)}"


def split_words(text: str) -> list[str]:
    """Return the words of a command line, as C++ splits them: blanks separate, and what stands in
    double quotes is one word.

    >>> split_words('--name "/my port" --x 1')
    ['--name', '/my port', '--x', '1']
    """
    words: list[str] = []
    word: str | None = None
    for number, part in enumerate(text.split('"')):
        if number % 2:
            word = (word or "") + part
            continue
        pieces = part.split()
        if not pieces:
            if part and word is not None:
                words.append(word)
                word = None
            continue
        if word is not None and part[0].isspace():
            words.append(word)
            word = None
        pieces[0] = (word or "") + pieces[0]
        words += pieces[:-1]
        word = pieces[-1]
        if part[-1].isspace():
            words.append(word)
            word = None
    return [*words, word] if word is not None else words


def circle(modules: Sequence[Module]) -> list[str]:
    """Return labels that wait for each other in a circle, none if there is no such."""
    after = {one.label: one.after for one in modules}
    done: set[str] = set()
    for start in after:
        path: list[str] = []
        stack: list[Iterator[str]] = [iter([start])]
        while stack:
            label = next(stack[-1], None)
            if label is None:
                stack.pop()
                if path:
                    done.add(path.pop())
            elif label in path:
                return [*path[path.index(label) :], label]
            elif label in after and label not in done:
                path.append(label)
                stack.append(iter(after[label]))
    return []
