"""The state of a server: which programs it has started, in files that outlive it.

    ~/.local/state/yarpy/run/%2FnodeA/     one folder for each server
        lock                               held by the server that runs
        3f2a....json .out .in .at          one program: the entry, its output, its input, the place
                                           up to which the output was told

Rules: only its user may read the folder. An entry stands there from before the program runs until
after it has ended; one of a computer that was restarted since is worth nothing.
"""

from __future__ import annotations

import json
import os
import secrets
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Final
from urllib.parse import quote

from yarpy.errors import AddressError
from yarpy.platform.file_lock import hold

_BOOT: Final = Path("/proc/sys/kernel/random/boot_id")
_LONGEST: Final = 1 << 20  # bytes of an entry


@dataclass(frozen=True, slots=True)
class Entry:
    """A program that was started. `port`: its log goes there; `uuid`: names its stdin and stdout,
    "" if there are none; `began`: as of `process_tree`."""

    id: str
    tag: str
    command: str
    environment: str = ""
    workdir: str = ""
    pid: int = 0
    began: int = 0
    port: str = ""
    logger: str = ""
    uuid: str = ""
    boot: str = ""


class StateFolder:
    """The folder of one server, which holds the lock of it. Raises AddressError if another one
    does, or the folder cannot be used."""

    def __init__(self, server: str, folder: str | Path | None = None) -> None:
        self.folder = Path(default_folder() if folder is None else folder) / quote(server, safe="")
        self._boot = _boot()
        try:
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            self.folder.chmod(0o700)
            self._lock = os.open(self.folder / "lock", os.O_RDWR | os.O_CREAT, 0o600)
        except OSError as error:
            raise AddressError(f"{self.folder} cannot be used: {error}") from error
        if not hold(self._lock):
            os.close(self._lock)
            raise AddressError(
                f"{server} runs already on this computer: `yarpy run --on {server} --exit` ends it"
            )

    def fresh(self) -> str:
        """Return the id of a new entry."""
        return secrets.token_hex(8)

    def path(self, id_: str, kind: str) -> Path:
        """Return a file of an entry. kind: json, out, in, at."""
        return self.folder / f"{id_}.{kind}"

    def write(self, entry: Entry) -> None:
        """Keep an entry, in one step. Raises OSError."""
        target = self.path(entry.id, "json")
        draft = target.with_suffix(".draft")
        told = asdict(entry) | {"boot": self._boot}
        with open(
            os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w", encoding="utf-8"
        ) as file:
            json.dump(told, file)
        draft.replace(target)

    def remove(self, id_: str) -> None:
        """Forget an entry, with its files."""
        for kind in ("json", "draft", "out", "in", "at"):
            with suppress(OSError):
                self.path(id_, kind).unlink()

    def entries(self) -> Iterator[Entry]:
        """Return the entries of programs that may still run; the others are removed. One without a
        process was begun by a server that was killed in that moment."""
        for file in sorted(self.folder.glob("*.json")):
            entry = _read(file)
            if entry is None or entry.boot != self._boot or entry.id != file.stem:
                self.remove(file.stem)
            else:
                yield entry

    def place(self, id_: str) -> int:
        """Return the place in an output up to which it was told, 0 if that is not known."""
        try:
            return max(0, int(self.path(id_, "at").read_text()))
        except (OSError, ValueError):
            return 0

    def set_place(self, id_: str, at: int) -> None:
        """Keep that place."""
        with suppress(OSError):
            self.path(id_, "at").write_text(str(at))

    def close(self) -> None:
        """Let another server have it; idempotent."""
        lock, self._lock = self._lock, -1
        if lock >= 0:
            os.close(lock)


def default_folder() -> Path:
    """Return where the folders of all servers are."""
    base = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local/state"
    return Path(base) / "yarpy" / "run"


def _boot() -> str:
    try:
        return _BOOT.read_text().strip()
    except OSError:
        return "unknown"


def _read(file: Path) -> Entry | None:
    try:
        if file.stat().st_size > _LONGEST:
            return None
        told = json.loads(file.read_text(encoding="utf-8"))
        numbers = ("pid", "began")
        kinds = {one.name: int if one.name in numbers else str for one in fields(Entry)}
        found = {key: told[key] for key in kinds}
    except (OSError, ValueError, KeyError, TypeError):
        return None
    if not all(type(found[key]) is kind for key, kind in kinds.items()):
        return None
    return Entry(**found)
