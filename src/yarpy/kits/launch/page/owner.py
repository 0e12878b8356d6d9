"""The program of an application that has a port, so that the graph of ports can be drawn.

Rules: a port itself says in which process it is; a process belongs to the program whose session it
is in. Where that is not known (a port that is not there yet, another computer), the command line
tells: `--name /camera` has `/camera` and `/camera/...`. What nobody claims is outside.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final

from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.kits.launch.application.application import Module
from yarpy.kits.launch.supervise import process
from yarpy.names.base import NameClient
from yarpy.network.asking import admin
from yarpy.network.traffic import PortState, read_port

AT_ONCE: Final = 3  # ports that are asked for one answer
_ANSWER: Final = 0.5  # seconds


def claimed(port: str, modules: Iterable[Module]) -> str:
    """Return the label of the program whose command line names a port, or the longest beginning of
    one; "" for none.

    >>> claimed("/cam/rpc", [Module("a", "camera", "--name /cam"), Module("b", "view", "/cam/out")])
    'a'
    """
    best, found = 0, ""
    for module in modules:
        for word in module.command:
            name = module.prefix + word.rpartition("=")[2]
            if not name.startswith("/") or len(name) <= best or name == "/":
                continue
            if port == name or port.startswith(f"{name}/"):
                best, found = len(name), module.label
    return found


class Owners:
    """Remembers the owner of each port. `sessions`: labels of programs by the session that they
    began here; `pid_of`: the process of a port, 0 for one that does not say."""

    def __init__(
        self,
        sessions: Callable[[], Mapping[int, str]],
        pid_of: Callable[[str], int] | None = None,
        names: NameClient | None = None,
    ) -> None:
        self._sessions = sessions
        self._names = names
        self._pid_of = pid_of or self._ask
        self._pids: dict[str, int] = {}

    def find(self, ports: Sequence[str], there: set[str], modules: Sequence[Module]) -> list[str]:
        """Return for each port the label of its program, "" for none of the application. `there`
        are those that are connected, and so worth asking."""
        sessions, asked, found = self._sessions(), 0, []
        for port in ports:
            label = self._of(port, sessions)
            if not label and port in there and asked < AT_ONCE:
                asked += 1
                self._pids[port] = self._pid_of(port)
                label = self._of(port, sessions)
            found.append(label or claimed(port, modules))
        return found

    def _of(self, port: str, sessions: Mapping[int, str]) -> str:
        pid = self._pids.get(port, 0)
        if not pid:
            return ""
        known = process.look(pid)
        label = sessions.get(known.session, "") if known is not None else ""
        if not label:
            self._pids.pop(port, None)  # of a program that has ended
        return label

    def _ask(self, port: str) -> int:
        state = PortState(port, Contact("", port))
        try:
            read_port(state, admin(port, "prop", "get", port, names=self._names, timeout=_ANSWER))
        except YarpError:
            return 0
        return state.pid
