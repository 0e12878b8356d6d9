"""The permission to run scripts: `YARPY_SCRIPTS`, in the environment of the program that owns the
port.

    (nothing)   those that the program itself requests (Port.connect, Port.attach)
    network     also those requested over the network: a sender's carrier string, `add` and `atch`
    system      Lua scripts have all of Lua: io, os, require of any file

Besides, `access.toml` may give a peer the right `script`, which is `network` for that peer alone.

Rules: a request over the network may name only a file in a context's folder, put there by the owner
of the machine: no path, no `..`. A Python script may do whatever its program may.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final

from yarpy.errors import LocalProtocolError
from yarpy.monitors.base import Place

SETTING: Final = "YARPY_SCRIPTS"
NETWORK: Final = "network"
SYSTEM: Final = "system"


def granted(word: str) -> bool:
    """Return whether the setting contains this word."""
    return word in os.environ.get(SETTING, "").replace(",", " ").split()


def look_for(place: Place, file: str, context: str) -> Iterator[Path]:
    """Return the paths that a script may have. Raises LocalProtocolError if it must not run."""
    if not place.foreign:
        return iter(place.look(file, [context] if context else []))
    if not (granted(NETWORK) or place.scripts):
        raise LocalProtocolError(
            "scripts requested over the network do not run here, unless the owner of this port "
            f"starts its program so: `{_command()}`; or allows them to you: `yarpy access allow "
            "script FROM`; or lets it attach the script itself (Port.attach)"
        )
    if not context or not (_is_plain(file) and _is_plain(context)):
        raise LocalProtocolError(
            "over the network a script must be a file in a context, +context.NAME+file.NAME, "
            f'not a path: "{file}" of "{context}"'
        )
    return _in_context(place.look(file, [context]), context, file)


def _command() -> str:
    """Return the command that the owner types; of the program its name alone, since a stranger
    reads it."""
    program = Path(sys.argv[0] if sys.argv else "").name
    start = f"python {program}" if program.endswith(".py") else program
    if start in ("", "-c", "-m"):
        start = "PROGRAM"
    return f"{SETTING}={NETWORK} {start} ..."


def _in_context(paths: Iterable[Path], context: str, file: str) -> Iterator[Path]:
    """The paths that lie in a folder of the context."""
    return (path for path in paths if path.parts[-3:] == ("contexts", context, file))


def _is_plain(name: str) -> bool:
    return name not in ("", ".", "..") and not any(c in name for c in "/\\:\0")
