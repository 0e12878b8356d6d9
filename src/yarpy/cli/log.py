"""The library's log on standard error: `[INFO] Port /r active at tcp://127.0.0.1:10002/`.

Rules: the texts are those of C++ YARP; its `|component|id|` part is left out. `YARP_QUIET` keeps
only warnings, `YARP_VERBOSE` shows everything, `YARP_COLORED_OUTPUT` decides about colours, which
otherwise only a terminal gets.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Mapping
from typing import Final

import click

from yarpy.config.configuration import flag

_COLOURS: Final = {"INFO": "blue", "WARNING": "yellow", "ERROR": "red", "CRITICAL": "red"}


def show(level: int = logging.INFO) -> None:
    """Show what the library logs at `level` and above, or as the environment says."""
    handler = logging.StreamHandler(sys.stderr)
    terminal = sys.stderr is not None and sys.stderr.isatty()
    handler.setFormatter(_Form(flag(os.environ, "YARP_COLORED_OUTPUT", terminal)))
    logger = logging.getLogger("yarpy")
    logger.handlers = [handler]
    logger.propagate = False
    logger.setLevel(chosen(os.environ, level))


def chosen(environment: Mapping[str, str], level: int) -> int:
    """The level that the environment asks for, else `level`."""
    if flag(environment, "YARP_QUIET", False):
        return logging.WARNING
    if flag(environment, "YARP_VERBOSE", False):
        return logging.DEBUG
    return level


class _Form(logging.Formatter):
    def __init__(self, coloured: bool) -> None:
        super().__init__("%(message)s")
        self._coloured = coloured

    def format(self, record: logging.LogRecord) -> str:
        level = record.levelname
        if self._coloured:
            level = click.style(level, fg=_COLOURS.get(level), bold=True)
        return f"[{level}] {super().format(record)}"
