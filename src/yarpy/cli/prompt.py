"""Lines that somebody types, or that a pipe brings.

Rules: at a terminal there is a prompt, line editing, history and completion; over a pipe there is
nothing of it. The last line counts also without its line end, and a line that begins with a
control character ends the input, as in C++. History is kept per prompt under the data home; where
it cannot be written there is none.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final

from yarpy.platform import input_lines

HISTORY: Final = 1000  # lines kept

Complete = Callable[[], list[str]]


def lines(prompt: str = ">>", history: str = "", complete: Complete | None = None) -> Iterator[str]:
    """The lines of standard input, without their ends.

    history: name of the file that remembers them. complete: the words that Tab offers, asked for
    when it is first pressed.
    """
    source = _typed(prompt, history, complete) if at_terminal() else _piped()
    for line in source:
        if line and line[0] < " " and line[0] != "\t":
            return
        yield line


def at_terminal() -> bool:
    """Return whether standard input and output are both a terminal."""
    # A standard stream that was closed before we began is None.
    return all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stdout))


def history_file(name: str) -> Path:
    """Return the file in which the lines typed at the prompt called `name` (a port) are kept."""
    from yarpy.config.configuration import safe_name
    from yarpy.platform.folders import data_home

    return data_home(os.environ) / "history" / safe_name(name).strip("_")


def _piped() -> Iterator[str]:
    for line in input_lines.lines():
        yield line.rstrip("\r\n")


def _typed(prompt: str, history: str, complete: Complete | None) -> Iterator[str]:
    readline = _readline()
    path = history_file(history) if history else None
    if readline is not None:
        readline.set_history_length(HISTORY)
        before = lambda: readline.get_line_buffer()[: readline.get_begidx()]  # noqa: E731
        readline.set_completer(Completer(complete, before) if complete is not None else None)
        # macOS has another library under the same name, with its own language.
        other = "libedit" in (readline.__doc__ or "")
        readline.parse_and_bind("bind ^I rl_complete" if other else "tab: complete")
        if path is not None:
            with contextlib.suppress(OSError):
                readline.read_history_file(path)
    try:
        while True:
            try:
                line = input(prompt)
            except EOFError:
                print()
                return
            yield line
    finally:
        if readline is not None and path is not None:
            with contextlib.suppress(OSError):
                path.parent.mkdir(parents=True, exist_ok=True)
                readline.write_history_file(path)


class Completer:
    """The completer that readline calls for the first, second ... word that `text` may become.

    `commands` gives lines of one word or several; a word is offered behind those that precede it.
    """

    def __init__(self, commands: Complete, typed: Callable[[], str] = lambda: "") -> None:
        self._commands = commands
        self._typed = typed  # the line before the word at the cursor
        self._known: list[list[str]] | None = None

    def __call__(self, text: str, number: int) -> str | None:
        if self._known is None:
            self._known = [command.split() for command in self._commands()]
        before = [word.strip("[]") for word in self._typed().split()]
        depth = len(before)
        words = (
            line[depth] for line in self._known if len(line) > depth and line[:depth] == before
        )
        found = [word for word in dict.fromkeys(words) if word.startswith(text)]
        # Python takes readline's blank behind a completed word away; here it is again.
        return f"{found[number]} " if number < len(found) else None


def _readline() -> Any:
    """The module, None where the system has none (Windows)."""
    try:
        import readline
    except ImportError:
        return None
    return readline
