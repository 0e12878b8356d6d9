"""yarpmanager-console: `yarpmanager-console [--application F.xml] [--run] ... [--exit]`, and words.

    load app NAME   run [IDs]   stop [IDs]   kill [IDs]   connect [IDs]   disconnect [IDs]   which
    check state [IDs]   check con [IDs]   check dep   list app   add app FILE   show mod NAME
    set OPTION VALUE   get OPTION   export FILE.dot   help   exit

Rules: what it prints has the forms of C++, without colours. What C++ does wrong is not repeated:
`connect` without numbers connects all, `check dep` says what is missing. A module that runs goes
on when the manager ends, and is found again.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from yarpy.config.command_line import parse_options
from yarpy.data.bottle import Property
from yarpy.data.text import plain_text
from yarpy.errors import YarpError
from yarpy.kits.launch.application.checking import checked
from yarpy.kits.launch.manager.drawing import dot
from yarpy.kits.launch.manager.session import Session
from yarpy.log import readable

VERSION: Final = "Version 1.1"
_WORDS: Final = (
    *("help", "exit", "list", "add", "load", "run", "stop", "kill", "connect", "disconnect"),
    *("which", "check", "set", "get", "export", "show", "assign"),
)
_POLICIES: Final = {"prompt": "no", "ignore": "no", "recover": "on-failure", "terminate": "no"}
_AT_ONCE: Final = (
    *("run", "stop", "kill", "connect", "disconnect", "assign_hosts", "check_dep"),
    *("check_state", "check_con"),
)


class Console:
    """One manager; `put` gets each line that it prints."""

    def __init__(self, session: Session, put: Callable[[str], None] = print) -> None:
        self.session = session
        self.settings = {"watchdog": "no", "auto_connect": "no", "module_failure": "prompt"}
        self._put = put

    def say(self, line: str) -> None:
        self._put(readable(line))

    def do(self, line: str) -> bool:
        """Do what a line says; return whether it was `exit`."""
        lexer = shlex.shlex(line, posix=True, punctuation_chars=False)
        lexer.whitespace_split = True
        lexer.commenters = lexer.escape = ""  # a backslash is one, as in paths of Windows
        try:
            words = [*lexer]
        except ValueError as error:
            self.say(f"ERROR:   {error}")
            return False
        if not words:
            return False
        word, rest = words[0], words[1:]
        if word == "exit":
            return True
        act = getattr(self, f"_{word}", None) if word in _WORDS else None
        if act is None:
            self.say(f"'{line.strip()}' is not correct. type \"help\" for more information.")
            return False
        try:
            act(rest)
        except (YarpError, OSError, ValueError, IndexError) as error:
            self.say(f"ERROR:   {error}")
        return False

    # -- words ------------------------------------------------------------------------------------

    def _help(self, rest: Sequence[str]) -> None:
        for text in (__doc__ or "").split("\n\n")[1].splitlines():
            self.say(text.strip())

    def _list(self, rest: Sequence[str]) -> None:
        kind = rest[0] if rest else "app"
        if kind == "app":
            for number, (name, path) in enumerate(self.session.files.items()):
                self.say(f"({number}) {name} [{path}]")
        elif kind not in ("mod", "res"):
            raise ValueError(f"list app, not {kind}")

    def _add(self, rest: Sequence[str]) -> None:
        kind, path = rest[0], rest[1]
        if kind != "app":
            self.say(f"WARNING: files of {kind} are not read: nothing needs them")
            return
        self._problems(self.session.add(Path(path).expanduser()))

    def _load(self, rest: Sequence[str]) -> None:
        if len(rest) != 2 or rest[0] != "app":
            raise ValueError("load app NAME")
        self._problems(self.session.choose(rest[1]))
        self._which([])

    def _which(self, rest: Sequence[str]) -> None:
        found = self.session.application
        self.say("Application: ")
        self.say(f"(0) {found.name} [{found.files[0] if found.files else ''}]")
        self.say("Modules: ")
        for number, one in enumerate(found.modules):
            settings = ";".join(f"{key}={value}" for key, value in one.environment.items())
            node = one.node or "localhost"
            self.say(f"({number}) {one.name} [{node}] [{one.parameters}] [{settings}]")
        self.say("Connections: ")
        for number, link in enumerate(found.connections):
            self.say(f"({number}) {link.source} - {link.target} [{link.carrier or 'tcp'}]")
        self.say("Resources: ")
        for number, name in enumerate(sorted({one.node or "localhost" for one in found.modules})):
            self.say(f"({number}) {name} [Computer]")
        for number, need in enumerate(found.needs):
            self.say(f"({number}) {need.port} [Port]")

    def _run(self, rest: Sequence[str]) -> None:
        self._errors(self.session.run(self._labels(rest)))
        self._check(["state", *rest])
        if self.settings["auto_connect"] == "yes":
            self._connect([])

    def _stop(self, rest: Sequence[str]) -> None:
        self._errors(self.session.stop(self._labels(rest)))
        self._check(["state", *rest])

    def _kill(self, rest: Sequence[str]) -> None:
        self._errors(self.session.stop(self._labels(rest), "kill"))
        self._check(["state", *rest])

    def _connect(self, rest: Sequence[str]) -> None:
        self._errors(self.session.join(self._numbers(rest), "connect"))
        self._check(["con", *rest])

    def _disconnect(self, rest: Sequence[str]) -> None:
        self._errors(self.session.join(self._numbers(rest), "disconnect"))
        self._check(["con", *rest])

    def _check(self, rest: Sequence[str]) -> None:
        kind, chosen = rest[0], rest[1:]
        if kind == "dep":
            some = False
            for problem in checked(self.session.application):
                some = True
                self.say(f"{'ERROR:  ' if problem.fatal else 'WARNING:'} {problem}")
            if not some:
                self.say("All of resource dependencies are satisfied.")
            return
        status = self.session.status()
        found = self.session.application
        if kind == "state":
            states = _by_name(status, "programs")
            for label in self._labels(chosen):
                number = [one.label for one in found.modules].index(label)
                one = found.modules[number]
                runs = states.get(label, {}).get("state") in ("running", "stopping")
                shown = "RUNNING" if runs else "STOPPED"
                self.say(f"<{shown}> ({number}) {one.name} [{one.node or 'localhost'}]")
        elif kind == "con":
            links = {(one["from"], one["to"]): one for one in _told(status, "connections")}
            for number in self._numbers(chosen):
                link = found.connections[number]
                known = links.get((link.source, link.target), {})
                joined = known.get("state") == "connected" or (not status and _joined(link))
                shown = "CONNECTED" if joined else "DISCONNECTED"
                ends = f"{link.source} - {link.target} [{link.carrier or 'tcp'}]"
                self.say(f"<{shown}> ({number}) {ends}")
        else:
            raise ValueError("check state, check con or check dep")

    def _set(self, rest: Sequence[str]) -> None:
        name, value = rest[0], rest[1]
        self.settings[name] = value
        if name == "module_failure":
            policy = _POLICIES.get(value, "no")
            self.session.options = ["--restart", policy, *_terminate(value)]

    def _get(self, rest: Sequence[str]) -> None:
        self.say(f"{rest[0]} = {self.settings.get(rest[0], '')}")

    def _export(self, rest: Sequence[str]) -> None:
        Path(rest[0]).expanduser().write_text(dot(self.session.application))

    def _show(self, rest: Sequence[str]) -> None:
        name = rest[1]
        for one in self.session.application.modules:
            if name in (one.name, one.label):
                self.say(f"Name       : {one.name}")
                self.say(f"Parameters : {one.parameters}")
                self.say(f"Node       : {one.node or 'localhost'}")
                self.say(f"Dependencies: {', '.join(need.port for need in one.needs)}")
                return
        raise ValueError(f"'{name}' not found.")

    def _assign(self, rest: Sequence[str]) -> None:
        self.say("WARNING: modules without a node run on this computer")

    # -- what words have in common ----------------------------------------------------------------

    def _labels(self, rest: Sequence[str]) -> list[str]:
        labels = [one.label for one in self.session.application.modules]
        return [labels[_index(word, len(labels))] for word in rest] or labels

    def _numbers(self, rest: Sequence[str]) -> list[int]:
        count = len(self.session.application.connections)
        return [_index(word, count) for word in rest] or [*range(count)]

    def _problems(self, application: Any) -> None:
        for problem in application.problems:
            self.say(
                f"{'ERROR:  ' if problem.fatal else 'WARNING:'} {problem.where}: {problem.text}"
            )

    def _errors(self, texts: Sequence[str]) -> None:
        for text in texts:
            self.say(f"ERROR:   {text}")


def _index(word: str, count: int) -> int:
    if not word.isdigit() or int(word) >= count:
        raise ValueError(f"there is no ({word})")
    return int(word)


def _told(status: dict[str, Any] | None, key: str) -> list[dict[str, Any]]:
    return [] if status is None else list(status[key])


def _by_name(status: dict[str, Any] | None, key: str) -> dict[str, dict[str, Any]]:
    return {one["name"]: one for one in _told(status, key)}


def _joined(link: Any) -> bool:
    from yarpy.network.connection import is_connected

    try:
        return is_connected(link.source, link.target)
    except YarpError:
        return False


def _terminate(value: str) -> list[str]:
    return ["--stop-on-failure"] if value == "terminate" else []


def settings(session: Session, options: Property) -> Iterator[tuple[str, str]]:
    """Yield the settings of `--from INI`, and add the applications that it names."""
    from yarpy.config.resource import Search

    name = _text(options, "from") or "ymanager.ini"
    path = Search().find(name)
    if path is None:
        if options.check("from"):
            print(f"ERROR:   cannot find {name}", file=sys.stderr)
        return
    from yarpy.config.ini import read_ini

    found = read_ini(path)
    deep = _text(found, "load_subfolders") == "yes"
    for key in ("module_failure", "auto_connect", "watchdog", "connection_failure"):
        if found.check(key):
            yield key, _text(found, key)
    for part in (_text(found, "apppath") or "./").split(";"):
        folder = (path.parent / part.strip()).expanduser()
        for problem in session.add_folder(folder, deep):
            print(f"WARNING: {problem}", file=sys.stderr)


def main(arguments: Sequence[str]) -> int:
    """The program: options first, then words from standard input until `exit` or its end."""
    options = parse_options(arguments)
    if options.check("help"):
        print((__doc__ or "").strip())
        return 0
    if options.check("version"):
        print(VERSION)
        return 0
    silent = options.check("silent")
    console = Console(Session(["--restart", "no"]), (lambda line: None) if silent else print)
    for key, value in settings(console.session, options):
        console.do(f"set {key} {value}")
    if options.check("application"):
        path = Path(_text(options, "application"))
        try:
            found = console.session.add(path)
        except YarpError as error:
            print(f"ERROR:   {error}", file=sys.stderr)
            return 1
        console.do(f'load app "{found.name}"')
        for word in _AT_ONCE:
            if options.check(word):
                console.do(word.replace("_", " "))
    if not options.check("exit"):
        _converse(console)
    if text := console.session.close():
        console.say(text)
    console.say("bye.")
    return 0


def _converse(console: Console) -> None:
    asks = sys.stdin is not None and sys.stdin.isatty()
    while True:
        try:
            line = input(">> ") if asks else input()
        except EOFError:
            return
        except KeyboardInterrupt:
            print('\ntype "exit" to end')
            continue
        if not console.do(line):
            continue
        if asks and console.session.running():
            sure = input("Some modules are running, and go on. Exit? [No/yes] ")
            if sure.strip().lower() not in ("y", "yes"):
                continue
        return


def _text(options: Property, key: str) -> str:
    return plain_text(options.find(key)) if options.check(key) else ""
