"""The state of a manager: files of applications, the one that is loaded, and who runs it.

Rules: an application is run by a `yarpy up --idle` of its own in the background, so it outlives the
manager, the next manager finds it again, and `yarpy status`, `logs` and `down` reach it as well.
Nothing is started before the first `run` or `connect`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError, YarpError
from yarpy.kits.launch.application.application import Application
from yarpy.kits.launch.application.load import content, load
from yarpy.kits.launch.console import control
from yarpy.kits.launch.console.detach import detach
from yarpy.kits.launch.document.element import parse

STARTUP_TIMEOUT: Final = 10.0  # seconds in which a program comes up, beyond what its file says
STOPPING: Final = 30.0  # ... and ends
_POLL: Final = 0.05  # seconds
_ENDED: Final = ("ended", "failed", "stopped")
_MOST: Final = 1000  # files of a folder


class Session:
    """Files, and one loaded application. `options` are those of `yarpy up`."""

    def __init__(self, options: Sequence[str] = ()) -> None:
        self.files: dict[str, Path] = {}
        self.loaded: Application | None = None
        self.options = options

    def add(self, path: Path) -> Application:
        """Take a file. Raises a YarpError that says what is wrong with it."""
        found = load(path)
        name = found.name or path.stem
        number = 1
        while name in self.files and self.files[name].resolve() != path.resolve():
            name, number = f"{found.name}({number})", number + 1
        self.files[name] = path
        return found

    def add_folder(self, folder: Path, deep: bool) -> Iterator[str]:
        """Take all applications of a folder; yield what is wrong with those that are not taken."""
        pattern = "**/*.xml" if deep else "*.xml"
        for path in sorted(folder.glob(pattern))[:_MOST]:
            try:
                if parse(content(path), str(path)).tag.lower() == "application":
                    self.add(path)  # modules and resources lie there, too
            except YarpError as error:
                yield str(error)

    def choose(self, name: str) -> Application:
        """Load an application by its name. Raises LocalProtocolError."""
        if self.loaded is not None and self.loaded.name != name and self.running():
            raise LocalProtocolError(
                f"{self.loaded.name} is running: stop it before another one is loaded"
            )
        if name not in self.files:
            raise LocalProtocolError(f"{name} does not exist.")
        self.loaded = load(self.files[name])
        return self.loaded

    @property
    def application(self) -> Application:
        """The one that is loaded. Raises LocalProtocolError if none is."""
        if self.loaded is None:
            raise LocalProtocolError('No application is loaded: "load app NAME" does that.')
        return self.loaded

    def status(self) -> dict[str, Any] | None:
        """Return how it is doing, None if nobody runs it."""
        name = self.application.name
        return control.ask(name, do="status") if name in control.running() else None

    def running(self) -> list[str]:
        """Return the programs that run, or are about to."""
        status = self.status() if self.loaded is not None else None
        if status is None:
            return []
        return [one["name"] for one in status["programs"] if one["state"] not in _ENDED]

    def run(self, labels: Sequence[str]) -> list[str]:
        """Start programs, and wait until they run; return what did not come up, with reasons."""
        self._ensure()
        for label in labels:
            control.ask(self.application.name, do="start", name=label)
        modules = {one.label: one for one in self.application.modules}
        wait = max((modules[label].delay for label in labels), default=0.0) + STARTUP_TIMEOUT
        needs = [need.timeout or 0.0 for label in labels for need in modules[label].needs]

        def missing(one: dict[str, Any]) -> bool:
            return one["state"] not in ("running", "ended")

        left = self._await(labels, missing, wait + max(needs, default=0.0), ("failed",))
        return [f"Failed to run {one['name']}: {one['detail'] or one['state']}" for one in left]

    def stop(self, labels: Sequence[str], word: str = "stop") -> list[str]:
        """End programs, by SIGKILL if `word` is "kill"; return what did not end."""
        if self.status() is None:
            return []
        for label in reversed(labels):
            control.ask(self.application.name, do=word, name=label)
        left = self._await(labels, lambda one: one["state"] not in _ENDED, STOPPING)
        return [f"Failed to stop {one['name']}: {one['detail'] or one['state']}" for one in left]

    def join(self, numbers: Sequence[int], word: str) -> list[str]:
        """Make connections (`connect`), or end them (`disconnect`); return what did not work."""
        self._ensure()
        wanted = [self.application.connections[number] for number in numbers]
        for one in wanted:
            control.ask(self.application.name, do=word, **{"from": one.source, "to": one.target})
        good = "connected" if word == "connect" else "off"
        until = time.monotonic() + STARTUP_TIMEOUT
        while True:
            links = {(one["from"], one["to"]): one for one in self._asked()["connections"]}
            left = [one for one in wanted if links[one.source, one.target]["state"] != good]
            over = time.monotonic() > until
            if over or all(links[one.source, one.target]["state"] == "refused" for one in left):
                return [
                    f"{one.label}: {links[one.source, one.target]['state']} "
                    f"{links[one.source, one.target]['detail']}"
                    for one in left
                ]
            time.sleep(_POLL)

    def close(self) -> str:
        """End who runs it, if nothing runs, and wait for that; return what is to be known."""
        status = self.status() if self.loaded is not None else None
        if status is None:
            return ""
        name = self.application.name
        if left := self.running():
            return f"{len(left)} modules run on: `yarpy status {name}`, `yarpy down {name}`"
        control.ask(name, do="down")
        until = time.monotonic() + STOPPING
        while name in control.running():
            if time.monotonic() > until:
                return f"{name} has not ended after {STOPPING:g} s: `yarpy status {name}` says why"
            time.sleep(_POLL)
        return ""

    def _asked(self) -> dict[str, Any]:
        return control.ask(self.application.name, do="status")

    def _ensure(self) -> None:
        """See that somebody runs it. Raises LocalProtocolError if it cannot be."""
        name = self.application.name
        if name not in control.running():
            file = self.files[name]
            detach(name, [str(file), "--idle", *self.options])

    def _await(
        self,
        labels: Sequence[str],
        unready: Callable[[dict[str, Any]], bool],
        seconds: float,
        hopeless: Sequence[str] = (),
    ) -> list[dict[str, Any]]:
        """Wait for programs; return those that are not as they should be after all."""
        until = time.monotonic() + seconds
        while True:
            programs = {one["name"]: one for one in self._asked()["programs"]}
            left = [programs[label] for label in labels if unready(programs[label])]
            if not any(one["state"] not in hopeless for one in left):
                return left
            if time.monotonic() > until:
                return left
            time.sleep(_POLL)
