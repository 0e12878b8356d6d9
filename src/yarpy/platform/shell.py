"""Lines that people type into the shell of their system.

    Linux, macOS    export NAME=VALUE    unset NAME    'text with & and $'
    Windows         set NAME=VALUE       set NAME=     "text with & and $", as cmd.exe takes it

A text that is a word as it is, such as `/icub/head`, has no quotes.

Rules: texts that are shown, which nothing runs. PowerShell writes $env:NAME = "VALUE" instead, and
takes the rest.
"""

from __future__ import annotations

import re
import shlex
import sys
from typing import Final

if sys.platform == "win32":
    _PLAIN: Final = re.compile(r"[\w@+:,./\\-]+", re.ASCII)

    def setting(name: str, value: str) -> str:
        """Return the line that gives a variable of the environment this value."""
        return f"set {name}={value}"

    def no_setting(name: str) -> str:
        """Return the line that takes a variable out of the environment."""
        return f"set {name}="

    def quoted(text: str) -> str:
        """Return the word that stands for a text; one with quotes of its own cannot be typed."""
        return text if _PLAIN.fullmatch(text) else f'"{text}"'

else:

    def setting(name: str, value: str) -> str:
        """Return the line that gives a variable of the environment this value."""
        return f"export {name}={value}"

    def no_setting(name: str) -> str:
        """Return the line that takes a variable out of the environment."""
        return f"unset {name}"

    def quoted(text: str) -> str:
        """Return the word that stands for a text."""
        return shlex.quote(text)
