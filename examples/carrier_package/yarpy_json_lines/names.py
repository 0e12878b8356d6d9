"""json_file: names of ports in a file that several programs share, without a server.

    YARPY_SERVER=json_file+/tmp/names.json yarpy name list

What is written here is what yarpy.names.base.NameClient and Foreign ask for.
"""

import json
import os
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from yarpy import Contact
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.registration_line import registration_line

T = TypeVar("T")


def open_names(host: str, port: int, namespace: str) -> "FileNames":
    """What the configuration says: the path stands where a host would."""
    return FileNames(host)


class FileNames:
    """A name client. Each change takes a lock file, and replaces the file as a whole."""

    allocates = False
    title = "names in a file"
    instead = "`yarpy server` starts a name server"
    hint = "the folder of the file has to be there: YARPY_SERVER=json_file+/PATH/names.json"

    def __init__(self, path: str) -> None:
        self.path = Path(path)
        self._lock = threading.Lock()

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        if not port:
            raise AddressError(f'a file gives out no port numbers: give one for "{name}"')
        if name.startswith("..."):
            name = f"/tmp/port/{port}"
        contact = Contact(carrier or "tcp", name, host or "127.0.0.1", port)
        self._change(lambda ports: ports.update({name: {"at": _words(contact)}}))
        return contact

    def unregister(self, name: str) -> None:
        self._change(lambda ports: ports.pop(name, None))

    def query(self, name: str) -> Contact | None:
        found = self._read().get(name)
        return None if found is None else Contact(*found["at"])

    def announce(self, name: str, ok: bool = True) -> None:
        """Nothing: there are no persistent connections without a server."""

    def set(self, name: str, key: str, *values: str | int | float) -> list[str]:
        texts = [str(value) for value in values]

        def keep(ports: dict[str, Any]) -> list[str]:
            if name not in ports:
                return []
            ports[name][key] = texts
            return texts

        return self._change(keep)

    def get(self, name: str, key: str) -> list[str]:
        return sorted(self._read().get(name, {}).get(key, []))

    def list(self, prefix: str | None = None) -> list[Contact]:
        below = None if prefix is None else prefix.rstrip("/") + "/"
        names = sorted(self._read().items())
        return [
            Contact(*port["at"])
            for name, port in names
            if below is None or name == prefix or name.startswith(below)
        ]

    def close(self) -> None:
        """Nothing is held between two calls."""

    # -- for `yarpy where`, `yarpy detect` and `yarpy name` ---------------------------------------

    def place(self) -> str:
        return str(self.path)

    def address(self) -> tuple[str, int]:
        return str(self.path), 0

    def alive(self) -> bool:
        return self.path.parent.is_dir()

    def line(self, contact: Contact) -> str:
        return registration_line(contact)

    # -- the file ---------------------------------------------------------------------------------

    def _read(self) -> dict[str, Any]:
        try:
            found: dict[str, Any] = json.loads(self.path.read_text("utf-8"))
            return found
        except FileNotFoundError:
            return {}
        except (OSError, ValueError) as error:
            raise NoNameServer(f"{self.path} cannot be read: {error}") from error

    def _change(self, change: Callable[[dict[str, Any]], T]) -> T:
        with self._lock, _Held(self.path.with_suffix(".lock")):
            ports = self._read()
            found = change(ports)
            fresh = self.path.with_suffix(".new")
            fresh.write_text(json.dumps(ports), "utf-8")
            fresh.replace(self.path)
            return found


class _Held:
    """A lock file, between programs; one that was left behind holds for two seconds."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> None:
        end = time.monotonic() + 2.0
        while True:
            try:
                return os.close(os.open(self._path, os.O_CREAT | os.O_EXCL))
            except FileExistsError:
                if time.monotonic() > end:
                    self._path.unlink(missing_ok=True)
                time.sleep(0.001)
            except OSError as error:
                raise NoNameServer(f"{self._path.parent} is no place for names: {error}") from error

    def __exit__(self, *details: object) -> None:
        self._path.unlink(missing_ok=True)


def _words(contact: Contact) -> tuple[str, str, str, int]:
    return contact.carrier, contact.name, contact.host, contact.port
