"""The socket of a running application, which only its owner can open.

Rules: one line of JSON there, one back: `{"do": "status"}`. The socket lies in a folder that
belongs to this user alone, and a lock beside it says whether somebody still runs; a supervisor that
was killed leaves its record, so that the next one finds out which programs are still there.
"""

from __future__ import annotations

import contextlib
import json
import re
import socket
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.supervise import process
from yarpy.limit import CONTROL_LINE, CONTROL_REPLY
from yarpy.platform import local_socket
from yarpy.platform.file_lock import hold
from yarpy.platform.file_place import remove
from yarpy.platform.user import user
from yarpy.transports.unix import runtime_directory

_TIMEOUT: Final = 10.0  # seconds that a request may take
_LONGEST: Final = 40  # letters of a name of a file

Answer = Callable[[dict[str, Any]], dict[str, Any]]


def folder() -> Path:
    """Return where the sockets are. Raises LocalProtocolError if others could write there."""
    path = runtime_directory() / "up"
    path.mkdir(parents=True, exist_ok=True, mode=0o700)
    found = path.lstat()
    if user() not in (None, found.st_uid):
        raise LocalProtocolError(f"another user has made {path}: set XDG_RUNTIME_DIR")
    if found.st_mode & 0o077:
        path.chmod(0o700)
    return path


def place(name: str, suffix: str) -> Path:
    """Return a file of the application `name`. Raises LocalProtocolError as `folder`."""
    safe = re.sub(r"[^\w.-]", "_", name, flags=re.ASCII)[:_LONGEST] or "_"
    return folder() / f"{safe}.{suffix}"


def running() -> list[str]:
    """Return the names of the applications that run."""
    return sorted(path.stem for path in folder().glob("*.sock") if _taken(path.stem))


def _taken(name: str) -> bool:
    """Return whether somebody holds the lock of a name."""
    try:
        with open(place(name, "lock"), "r+b") as file:
            return not hold(file.fileno())
    except FileNotFoundError:
        return False


def ask(name: str, /, **request: Any) -> dict[str, Any]:
    """Return the answer of a running application. Raises LocalProtocolError if none of that name
    runs, or it refuses."""
    try:
        with local_socket.connect(place(name, "sock"), _TIMEOUT) as link:
            link.sendall(json.dumps(request).encode() + b"\n")
            with link.makefile("rb") as file:
                line = file.readline(CONTROL_REPLY)
        answer = json.loads(line)
    except (FileNotFoundError, ConnectionError):
        known = ", ".join(f'"{one}"' for one in running())
        raise LocalProtocolError(
            f'no application called "{name}" runs here; {f"these do: {known}" if known else ""}'
            f"{'' if known else '`yarpy up FILE` starts one'}"
        ) from None
    except (OSError, ValueError) as error:
        raise LocalProtocolError(f'"{name}" does not answer: {error}') from error
    if "error" in answer:
        raise LocalProtocolError(str(answer["error"]))
    found: dict[str, Any] = answer
    return found


class Record:
    """The place of a running application: held by one process until it is closed, or killed.
    Raises LocalProtocolError if another process has it."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._file = open(place(name, "lock"), "a+b")  # noqa: SIM115
        if not hold(self._file.fileno()):
            self._file.close()
            raise LocalProtocolError(
                f'"{name}" is running already: `yarpy status {name}` shows it, `yarpy down {name}` '
                "ends it"
            )
        self._path = place(name, "json")

    def left(self) -> dict[int, str]:
        """Return the processes of a supervisor that was killed, each with the program's name."""
        try:
            told = json.loads(self._path.read_bytes())
            run, labels = str(told["run"]), [str(label) for label in told["programs"]]
        except (OSError, ValueError, KeyError, TypeError):
            return {}
        marks = {f"{run}/{label}" for label in labels}
        found = process.members({}, marks)
        return {pid: mark.partition("/")[2] for pid, mark in found.items()}

    def away(self) -> dict[str, str]:
        """Return the tags of programs that one before has left at servers, each with its server."""
        try:
            told = json.loads(self._path.read_bytes())
            return {str(tag): str(server) for tag, server in told["away"].items()}
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return {}

    def write(self, run: str, labels: list[str], away: Mapping[str, str] | None = None) -> None:
        """Remember what is about to be started; `away`: the tags of programs at servers."""
        told = {"run": run, "programs": labels, "away": dict(away or {})}
        self._path.write_text(json.dumps(told))

    def close(self, away: Mapping[str, str] | None = None) -> None:
        """Give the place back; all has ended, but for what may go on at servers."""
        if away:
            self.write("", [], away)
        else:
            remove(self._path)
        self.leave()

    def leave(self) -> None:
        """Give the place back, but not what is remembered there."""
        self._file.close()


class Control:
    """Answers requests until it is closed."""

    def __init__(self, name: str, answer: Answer) -> None:
        self._answer = answer
        self._listener = local_socket.Listener(place(name, "sock"))
        self._thread = threading.Thread(target=self._serve, name="yarpy control", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End, and take the socket away."""
        self._listener.close()
        self._thread.join(_TIMEOUT)

    def _serve(self) -> None:
        while True:
            try:
                link = self._listener.accept()
            except OSError:
                return
            with link:
                link.settimeout(_TIMEOUT)
                with contextlib.suppress(OSError):
                    link.sendall(json.dumps(self._reply(link)).encode() + b"\n")

    def _reply(self, link: socket.socket) -> dict[str, Any]:
        with link.makefile("rb") as file:
            line = file.readline(CONTROL_LINE)
        try:
            asked = json.loads(line)
            if not isinstance(asked, dict):
                raise ValueError("no object")
        except (ValueError, RecursionError) as error:
            return {"error": f"this is no request: {error}"}
        try:
            return self._answer(asked)
        except Exception as error:  # whoever asked is told
            return {"error": str(error) or type(error).__name__}
