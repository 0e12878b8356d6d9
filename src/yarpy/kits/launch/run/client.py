"""The client of a server that starts programs, yarpy's or C++ yarprun.

    with RunClient("/nodeA") as node:
        pid = node.start("cam", ["yarpdev", "--device", "fakeFrameGrabber"])
        node.is_running("cam")
        node.signal("cam", signal.SIGTERM)

Rules: a server that refuses or cannot is an error that says why. C++ servers answer nothing they do
not know, so every question has an end.
"""

from __future__ import annotations

import signal
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Self

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import AccessRefused, RemoteError
from yarpy.kits.launch.run.command_line import joined
from yarpy.names.base import NameClient
from yarpy.port.rpc import RpcClient

TIMEOUT: Final = 10.0  # seconds for an answer


@dataclass(frozen=True, slots=True)
class Started:
    """A program that was started. `uuid` names its terminal, "" without one; `text` is what the
    server said."""

    pid: int
    text: str
    uuid: str = ""


@dataclass(frozen=True, slots=True)
class Running:
    """A program that runs."""

    pid: int
    tag: str
    command: str
    environment: str = ""


class RunClient:
    """Asks the server called `server`. Raises UnknownName, LinkClosed, Timeout, AccessRefused."""

    def __init__(
        self, server: str, *, timeout: float = TIMEOUT, names: NameClient | None = None
    ) -> None:
        self.server = server
        self._client: RpcClient[Any] = RpcClient(server, names=names, timeout=timeout)

    def close(self) -> None:
        """Ask no more."""
        self._client.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def start(
        self,
        tag: str,
        command: str | Sequence[str],
        *,
        workdir: str = "",
        environment: Mapping[str, str] | str = "",
        log: str | None = None,
        stdio: str = "",
    ) -> Started:
        """Start a program under a tag. log: what it says goes to that logger ("" for the usual
        one). stdio: it gets a terminal, of the server of that name. Raises RemoteError, which says
        why it was not."""
        said = command if isinstance(command, str) else joined([*command])
        if not isinstance(environment, str):
            environment = ";".join(f"{key}={value}" for key, value in environment.items())
        request: list[list[object]] = [["stdio", stdio]] if stdio else []
        request += [["cmd", said], ["as", tag], ["on", self.server]]
        if workdir:
            request.append(["workdir", workdir])
        if environment:
            request.append(["env", environment])
        if log is not None:
            request.append(["log", log] if log else ["log"])
        answer = self._ask(*request)
        words = [*answer, "", "", ""]
        pid, text = words[0], plain_text(words[1]).strip()
        if not isinstance(pid, int) or pid <= 0:
            kind = AccessRefused if "not among the programs" in text else RemoteError
            raise kind(text or f"{self.server} does not say why it did not start {tag}")
        return Started(pid, text, plain_text(words[2]) if stdio else "")

    def signal(self, tag: str, number: int) -> bool:
        """Send all programs with that tag a signal; return whether there is one."""
        if number == signal.SIGTERM:
            return self._said(["sigterm", tag]).endswith("OK")
        return self._said(["kill", tag, int(number)]).endswith("OK")

    def end_all(self) -> None:
        """Ask all programs of the server to end."""
        self._said(["sigtermall"])

    def is_running(self, tag: str) -> bool:
        """Return whether a program with that tag runs."""
        return self._said(["isrunning", tag]) == "running"

    def ending(self, tag: str) -> tuple[bool, int | None]:
        """Return whether a program with that tag runs, and the code that the last one ended with,
        minus the number of a signal; None for none, and at servers of C++."""
        answer = self._ask(["isrunning", tag], ["code"])
        code = answer[1] if len(answer) > 1 else None
        return bool(answer) and plain_text(answer[0]) == "running", (
            code if isinstance(code, int) else None
        )

    def running(self) -> list[Running]:
        """Return the programs of the server."""
        found = []
        for item in self._ask(["ps"]):
            if not isinstance(item, Bottle):
                continue
            pid = item.find("pid", 0)
            words = (plain_text(item.find(key, "")) for key in ("tag", "cmd", "env"))
            found.append(Running(pid if isinstance(pid, int) else 0, *words))
        return found

    def output(self, tag: str) -> list[str]:
        """Return the last lines that programs with that tag have said. Raises RemoteError at
        servers of C++, which keep none."""
        answer = self._ask(["isrunning", tag], ["output"])
        if len(answer) < 2:
            raise RemoteError(
                f"{self.server} is C++ yarprun, which keeps no output: start the program with --log"
            )
        return [plain_text(line) for line in answer[1]]

    def which(self, file: str) -> str:
        """Return the file that a name stands for over there."""
        return self._said(["which", file]).strip('"')

    def exit(self) -> None:
        """Ask the server to end."""
        self._said(["exit"])

    def _ask(self, *groups: list[object]) -> list[Any]:
        answer = self._client.call(Bottle(Bottle(group) for group in groups))
        return answer if isinstance(answer, list) else [answer]

    def _said(self, *groups: list[object]) -> str:
        answer = self._ask(*groups)
        if len(answer) == 2 and answer[0] == -1:
            raise RemoteError(plain_text(answer[1]).strip())
        return plain_text(answer[0]) if answer else ""
