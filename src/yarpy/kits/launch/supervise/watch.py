"""Files of a running application, looked at again and again: what has changed starts again.

Rules: the files of its description, and those that command lines name: programs that are not on the
PATH, scripts, configuration. A description that cannot be read, or has errors, changes nothing. A
file counts as changed once it stays the same between two looks, so that one which is being written
is not taken half; one that vanishes is waited for.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Final

from yarpy.errors import YarpError
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.supervise.supervisor import Supervisor

PERIOD: Final = 0.5  # seconds between looks
_MOST: Final = 5000  # files

State = tuple[int, int, int] | None  # of a file: when it was written, its size, its number


def named(module: Module) -> list[Path]:
    """Return the files that the command line of a program names, those on this computer."""
    if module.node:
        return []
    folder = Path(module.workdir) if module.workdir else Path()
    found = []
    for word in module.command:
        value = word.rpartition("=")[2] if word.startswith("-") else word
        path = folder / value if value else folder
        try:
            if "\0" not in value and path.is_file():
                found.append(path)
        except OSError:
            continue  # too long for a name, or another user's
    return found


class Watch:
    """Watches from `start` to `close`. `load` reads the description anew; `news` gets what happens,
    for people; `changed` is called after the application has become another one."""

    def __init__(
        self,
        supervisor: Supervisor,
        load: Callable[[], Application],
        news: Callable[[str, str], None],
        changed: Callable[[], None] = lambda: None,
        period: float = PERIOD,
    ) -> None:
        self._supervisor = supervisor
        self._load = load
        self._news = news
        self._changed = changed
        self._period = period
        self._over = threading.Event()
        self._files: dict[Path, set[str]] = {}  # the programs that use each, "" the description
        self._known: dict[Path, State] = {}  # as it was when all of it was read
        self._last: dict[Path, State] = {}  # as it was at the last look
        self._gather()
        self._thread = threading.Thread(target=self._run, name="yarpy watch", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def close(self) -> None:
        """Look no more; what is being started goes on."""
        self._over.set()

    def look(self) -> None:
        """Look once, and do what is to be done."""
        now = {path: _state(path) for path in self._files}
        settled = {
            path
            for path, state in now.items()
            if state is not None
            and state != self._known.get(path)
            and state == self._last.get(path)
        }
        self._last = now
        if not settled:
            return
        self._known.update((path, now[path]) for path in settled)
        labels = {label for path in settled for label in self._files[path]}
        if "" in labels:
            labels -= self._reload()
        for label in labels - {""}:
            if label in self._supervisor.units:
                names = sorted(path.name for path in settled if label in self._files[path])
                self._news(label, f"starts again: {', '.join(names)} has changed")
                self._supervisor.restart(label)
        self._gather()

    def _reload(self) -> set[str]:
        """Become what the description says now; return the programs that were started anew."""
        try:
            application = self._load()
        except YarpError as error:
            self._news("", f"{error}; all runs on as it was")
            return set()
        problems = [one for one in application.problems if one.fatal]
        for problem in problems or application.problems:
            self._news("", str(problem))
        if problems:
            self._news("", "all runs on as it was")
            return set()
        before = {**self._supervisor.units}
        for text in self._supervisor.change(application):
            self._news("", text)
        self._changed()
        units = self._supervisor.units
        return {label for label, unit in units.items() if before.get(label) is not unit}

    def _gather(self) -> None:
        files: dict[Path, set[str]] = {}
        application = self._supervisor.application
        for path in map(Path, application.files):
            files.setdefault(path, set()).add("")
        for module in application.modules:
            for path in named(module):
                files.setdefault(path, set()).add(module.label)
        self._files = dict(_first(files.items(), _MOST))
        for path in self._files:
            if path not in self._known:
                self._known[path] = _state(path)

    def _run(self) -> None:
        while not self._over.wait(self._period):
            try:
                self.look()
            except Exception as error:  # a watch that ended in silence would be worse
                self._news("", f"the watch of files: {type(error).__name__}: {error}")


def _first(items: Iterable[tuple[Path, set[str]]], most: int) -> list[tuple[Path, set[str]]]:
    return [*items][:most]


def _state(path: Path) -> State:
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
