"""The answers of a running application to other commands.

    {"do": "status"}                                    how all of it is doing
    {"do": "logs", "name": "", "since": 0, "most": 100}  lines of one program, or of all
    {"do": "restart", "name": "robot"}                  end it and start it again
    {"do": "stop", "name": "robot"}                     end it, and leave it so
    {"do": "kill", "name": "robot"}                     the same with SIGKILL
    {"do": "start", "name": "robot"}                    start it, if it does not run
    {"do": "connect", "from": "/a", "to": "/b"}         keep a connection that was let go
    {"do": "disconnect", "from": "/a", "to": "/b"}      let one go
    {"do": "down"}                                      end all

Rules: an answer is JSON; what cannot be done raises, and the other side is told why.
"""

from __future__ import annotations

import os
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.supervise.supervisor import Supervisor
from yarpy.limit import CONTROL_REPLY

WORDS: Final = (
    *("status", "logs", "restart", "stop", "kill", "start", "connect", "disconnect", "down"),
)
_BYTES: Final = CONTROL_REPLY // 8  # of lines; JSON may need six letters for one byte


def answer(supervisor: Supervisor, asked: dict[str, Any]) -> dict[str, Any]:
    """Return the answer to a request. Raises a YarpError for what cannot be done."""
    word, name = asked.get("do"), str(asked.get("name", ""))
    if word == "status":
        return {**supervisor.status(), "pid": os.getpid(), "files": supervisor.application.files}
    if word == "restart":
        supervisor.restart(name)
        return {"ok": True}
    if word in ("stop", "kill"):
        supervisor.take_off(name, at_once=word == "kill")
        return {"ok": True}
    if word == "start":
        supervisor.begin(name)
        return {"ok": True}
    if word in ("connect", "disconnect"):
        source, target = str(asked.get("from", "")), str(asked.get("to", ""))
        connections = supervisor.connections
        (connections.take_up if word == "connect" else connections.let_go)(source, target)
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
    raise LocalProtocolError(f'"{word}" is none of {", ".join(WORDS)}')
