"""Lines that people type into the shell of their system.

    Linux, macOS    export NAME=VALUE       unset NAME           'text with & and $'
    PowerShell      $env:NAME = 'VALUE'     $env:NAME = $null    'text with & and $'
    cmd.exe         set NAME=VALUE          set NAME=            "text with & and $"

A text that is a word as it is, such as `/icub/head`, has no quotes.

Rules: texts that are shown, which nothing runs. On Windows they are for PowerShell where one has
started this program, or what has started it: there `set NAME=VALUE` is no error, and sets nothing
that a program sees. Else they are for cmd.exe.
"""

from __future__ import annotations

import re
import shlex
import sys
from functools import cache
from typing import Final

if sys.platform == "win32":
    from yarpy.platform.process import ancestors

    _PLAIN: Final = re.compile(r"[\w+:./\\-]+", re.ASCII)
    _SHELLS: Final = {"powershell.exe": True, "pwsh.exe": True, "cmd.exe": False}

    @cache
    def _in_powershell() -> bool:
        """Return whether the nearest shell is PowerShell."""
        names = (name.lower() for name in ancestors())
        return next((_SHELLS[name] for name in names if name in _SHELLS), False)

    def setting(name: str, value: str) -> str:
        """Return the line that gives a variable of the environment this value."""
        return f"$env:{name} = '{value}'" if _in_powershell() else f"set {name}={value}"

    def no_setting(name: str) -> str:
        """Return the line that takes a variable out of the environment."""
        return f"$env:{name} = $null" if _in_powershell() else f"set {name}="

    def quoted(text: str) -> str:
        """Return the word that stands for a text; cmd.exe takes none with quotes of its own."""
        if _PLAIN.fullmatch(text):
            return text
        return "'" + text.replace("'", "''") + "'" if _in_powershell() else f'"{text}"'

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
