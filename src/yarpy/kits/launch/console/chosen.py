"""The choice of the running application that a command is about: by its name, by its file, or the
only one."""

from __future__ import annotations

from pathlib import Path

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.application.load import load
from yarpy.kits.launch.console import control


def chosen(text: str) -> str:
    """Return the name of the application that is meant. Raises LocalProtocolError if that is not
    clear."""
    if text:
        path = Path(text)
        return load(path).name if path.suffix and path.is_file() else text
    known = control.running()
    if len(known) == 1:
        return known[0]
    if known:
        raise LocalProtocolError(f"several applications run here, say which: {', '.join(known)}")
    raise LocalProtocolError("no application runs here: `yarpy up FILE` starts one")
