"""Requests to a yarprun server, and its answers.

    (cmd "sleep 60") (as tag1)       31991 "STARTED: server=/nodeA alias=tag1 ..."
    (isrunning tag1)                 "running"
    (isrunning tag1) (code)          "not running" -9        the code is left out by C++
    (isrunning tag1) (output)        "running" ("a line" "another")     and so is the output

Rules: pure. A request is a Bottle of lists, each of which begins with a word that is looked for in
a fixed order: those of C++ yarprun. That one passes over what is said beside a word that it knows,
and never answers anybody again once it was asked one that it does not know.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text

#: In the order in which they count.
VERBS: Final = (
    *("stdio", "cmd", "kill", "sigterm", "sigtermall", "ps", "isrunning", "killstdio"),
    *("sysinfo", "which", "exit"),
)


@dataclass(frozen=True, slots=True)
class Request:
    """A request: the word that counts ("" for none), and the words behind each."""

    verb: str
    groups: dict[str, list[Any]]

    def __contains__(self, key: str) -> bool:
        return key in self.groups

    def text(self, key: str, at: int = 0) -> str:
        """Return a word behind `key`, "" if there is none."""
        words = self.groups.get(key, [])
        return plain_text(words[at]) if at < len(words) else ""

    def number(self, key: str, at: int = 0) -> int:
        """Return a number behind `key`, 0 if there is none."""
        words = self.groups.get(key, [])
        found = words[at] if at < len(words) else 0
        return found if isinstance(found, int) and not isinstance(found, bool) else 0

    @property
    def command(self) -> str:
        """Return the command, also where its words stand one by one."""
        words = self.groups.get("cmd", [])
        return " ".join(map(plain_text, words))


def read(value: object) -> Request:
    """Return what a message asks for."""
    groups: dict[str, list[Any]] = {}
    for item in value if isinstance(value, list) else ():
        if isinstance(item, list) and item and isinstance(item[0], str):
            groups.setdefault(plain_text(item[0]), list(item[1:]))
    verb = next((verb for verb in VERBS if verb in groups), "")
    return Request(verb, groups)


def started(server: str, tag: str, command: str, pid: int, uuid: str = "") -> Bottle:
    """Return the answer for a program that runs."""
    text = f"STARTED: server={server} alias={tag} cmd={command} pid={pid}\n"
    return Bottle([pid, text, *([uuid] if uuid else [])])


def aborted(server: str, tag: str, command: str, why: str) -> Bottle:
    """Return the answer for a program that does not."""
    head = f"ABORTED: server={server} alias={tag} cmd={command}"
    return Bottle([-1, f"{head}\nCan't execute command because {why}\n"])
