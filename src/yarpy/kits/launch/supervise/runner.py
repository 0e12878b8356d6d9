"""The contract of what starts programs, here (`local`) or on other computers (`run`).

Rules: a Runner is told of a Program and gives a Handle at once; whatever the program does then
comes through the two callbacks, from threads of the runner, and never after `on_end`. Nothing here
starts anything.
"""

from __future__ import annotations

import signal
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol


@dataclass(frozen=True, slots=True)
class Program:
    """A program that is to be started.

    `name` is unique in its application; `command` the program and its arguments; `workdir` ""
    stands for the current folder; `environment` is added to that of whoever starts it; `stdio`
    names the server of a terminal for it, "" for none; `host` the server that starts it, "" for
    here.
    """

    name: str
    command: Sequence[str]
    workdir: str = ""
    environment: Mapping[str, str] = field(default_factory=dict)
    stdio: str = ""
    host: str = ""


class Handle(Protocol):
    """A program that was started."""

    @property
    def pid(self) -> int:
        """The number of its process, on the computer where it runs."""

    @property
    def state(self) -> str:
        """`running`, `ended`, or `unknown` while its computer does not answer."""

    @property
    def detail(self) -> str:
        """The reason of `unknown`."""

    @property
    def returncode(self) -> int | None:
        """The exit code, or minus the number of the signal that ended it; None while it runs."""

    def terminate(self, number: int = signal.SIGTERM) -> None:
        """Send a signal to the program and all that it has started; nothing if it has ended."""

    def wait(self, timeout: float | None = None) -> int | None:
        """Return what it ended with, None if it still runs after `timeout` seconds."""


class Runner(Protocol):
    """Starts programs."""

    def start(
        self,
        program: Program,
        on_line: Callable[[str], None],
        on_end: Callable[[int | None], None],
    ) -> Handle:
        """Start a program. `on_line` gets each line of its output, without the line's end and cut
        where it is too long; `on_end` gets what it ended with, None if nobody knows, after its last
        line, once. Raises OSError where it cannot be started here, a YarpError where its computer
        refuses or does not answer."""
