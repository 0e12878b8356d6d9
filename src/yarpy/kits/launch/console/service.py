"""The answers of a running application to other commands.

    {"do": "status"}                                    how all of it is doing
    {"do": "logs", "name": "", "since": 0, "most": 100}  lines of one program, or of all
    {"do": "restart", "name": "robot"}                  end it and start it again
    {"do": "down"}                                      end all

Rules: an answer is JSON; what cannot be done raises, and the other side is told why.
"""

from __future__ import annotations

import os
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.limit import CONTROL_REPLY

_BYTES: Final = CONTROL_REPLY // 8  # of lines; JSON may need six letters for one byte


def answer(supervisor: Supervisor, asked: dict[str, Any]) -> dict[str, Any]:
    """Return the answer to a request. Raises a YarpError for what cannot be done."""
    word, name = asked.get("do"), str(asked.get("name", ""))
    if word == "status":
        return {**supervisor.status(), "pid": os.getpid()}
    if word == "restart":
        supervisor.restart(name)
        return {"ok": True}
    if word == "down":
        supervisor.over.set()
        return {"ok": True}
    if word == "logs":
        since, most = int(asked.get("since", 0)), int(asked.get("most", 100))
        found = supervisor.lines(name, since, most)
        room, first = _BYTES, len(found)
        while first > 0 and room > 0:
            first -= 1
            room -= len(found[first][2]) + 100
        return {"lines": found[first:]}
    raise LocalProtocolError(f'"{word}" is none of status, logs, restart, down')
