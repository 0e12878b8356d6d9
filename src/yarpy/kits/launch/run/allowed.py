"""The programs that a server may start: any of them for its owner, or those of a list for
everybody.

    allowed = Allowed(["yarpdev", "python3 /opt/lab/arm.py"])
    allowed.check(["yarpdev", "--device", "fakeFrameGrabber"], {}, "/nodeA")

Rules: an entry is a program, or a program with its first words; a command has to begin with all of
them. The program is the file that the name stands for on this computer, so that another one of the
same name in somebody's working directory is not meant. With a list, the environment may hold only
what changes no program into another: DISPLAY, what the owner names, and YARP_... that does not say
where programs find their files, which would be other rules of access, name servers and plug-ins.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Mapping, Sequence
from typing import Final

from yarpy.errors import AccessRefused
from yarpy.kits.launch.run.command_line import words_of

HARMLESS: Final = ("DISPLAY", "LANG", "TZ")
PREFIX: Final = "YARP_"
#: How the names of variables end that say where files are, as YARP_CONFIG_HOME and YARP_DATA_DIRS.
PLACES: Final = ("_HOME", "_DIRS", "_DIR", "_PATH", "_CONF")
#: Its value becomes the name of a folder.
FOLDER: Final = "YARP_ROBOT_NAME"


class Allowed:
    """The list of an owner; empty: any program, for the owner alone."""

    def __init__(self, entries: Iterable[str] = (), variables: Iterable[str] = ()) -> None:
        self.entries = tuple(tuple(words_of(entry)) for entry in entries)
        self._variables = frozenset((*HARMLESS, *variables))

    def __bool__(self) -> bool:
        return bool(self.entries)

    def check(self, words: Sequence[str], variables: Mapping[str, str], server: str) -> None:
        """Raise AccessRefused, which tells the owner what to type, for what is not on the list."""
        if not self.entries:
            return
        program = located(words[0])
        if not any(
            program == located(entry[0]) and tuple(words[1 : len(entry)]) == entry[1:]
            for entry in self.entries
        ):
            raise AccessRefused(
                f'"{words[0]}" is not among the programs that {server} may start; to allow it, its '
                f'owner adds: yarpy run --server {server} --allow "{words[0]}"'
            )
        for name, value in variables.items():
            if not (name in self._variables or _is_harmless(name, value)):
                raise AccessRefused(
                    f"the variable {name} may make a program do anything; to allow it, the owner "
                    f"of {server} adds: --allow-env {name}"
                )

    def path(self, program: str) -> str | None:
        """Return the file to start instead of a name, None if any file may be."""
        return located(program) if self.entries else None


def _is_harmless(name: str, value: str) -> bool:
    """Return whether a variable of YARP leads to no other files."""
    if not name.startswith(PREFIX) or name.endswith(PLACES):
        return False
    return name != FOLDER or not ("/" in value or ".." in value)


def located(program: str) -> str:
    """Return the file that a name stands for; the name itself if there is none. Of links the last
    one stays: programs look at the name by which they were started."""
    found = shutil.which(program)
    if found is None:
        return program
    folder, name = os.path.split(os.path.abspath(found))
    return os.path.join(os.path.realpath(folder), name)
