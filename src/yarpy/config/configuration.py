"""The addresses of the name servers, read from the same files and variables that C++ YARP uses.

Rules: functions of an environment mapping and a directory, so that nothing here depends on the
process it runs in. Nothing is printed.

    yarp_namespace.conf   the namespaces, as Bottle text; none means /root
    yarp.conf             the address of the server of /root: `HOST PORT [MODE]`
    _name.conf            the same for namespace /name

`YARPY_SERVER=HOST:PORT` takes precedence over every file and may list several, separated by commas.
Name services of other systems are there by their plug-in's name and a place, `NAME+PLACE`; in a
file the name is the mode.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from yarpy.errors import AddressError
from yarpy.platform.file_place import replace
from yarpy.platform.folders import conf_directory
from yarpy.registry import names

DEFAULT_PORT = 10000
ROOT = "/root"
YARP, LOCAL = "yarp", "local"

_YES = frozenset({"1", "true", "yes", "on"})
_NO = frozenset({"0", "false", "no", "off"})
_UNSAFE = re.compile(r"[^0-9A-Za-z]")


@dataclass(frozen=True, slots=True)
class Server:
    """One configured name service. `mode`: yarp, local (no server at all), or the name of a plug-in
    of the group `yarpy.names`: what `host` means is then its business, if `port` is 0."""

    host: str
    port: int
    mode: str = YARP
    namespace: str = ROOT
    path: Path | None = None  # the file that says so; None: the environment does


@dataclass(frozen=True, slots=True)
class Configuration:
    """The name servers configured for a program.

    `servers` in order of preference, empty if the first namespace has no address, in which case C++
    programs count as not configured. `missing` are the namespaces without an address file.
    """

    servers: tuple[Server, ...]
    missing: tuple[str, ...]
    directory: Path

    @property
    def namespace(self) -> str:
        """The namespace in use, for messages and for writing."""
        if self.servers:
            return self.servers[0].namespace
        return self.missing[0] if self.missing else ROOT


class BrokenFile(AddressError):
    """An address file that holds no address; made of which file, and what is wrong."""

    @property
    def reason(self) -> str:
        """The file and what is wrong with it, for a caller who writes the file anew."""
        return str(self.args[0])

    def __str__(self) -> str:
        return f"{self.reason}; `yarpy conf HOST PORT` writes the file anew"


def configuration(
    environment: Mapping[str, str],
    directory: Path | None = None,
    on_broken: Callable[[str], None] | None = None,
) -> Configuration:
    """Everything the environment and the files in `directory` say about name servers.

    Raises AddressError for an invalid address, naming its source. With `on_broken` a file that
    holds none counts as not there, and `on_broken` is told which and why: for who writes it anew.
    """
    directory = conf_directory(environment) if directory is None else directory
    listed = environment.get("YARPY_SERVER", "").strip()
    if listed:
        servers = tuple(
            _parse_host_port(item.strip(), environment)
            for item in listed.split(",")
            if item.strip()
        )
        return Configuration(servers, (), directory)
    found: list[Server] = []
    missing: list[str] = []
    for namespace in namespaces(environment, directory):
        try:
            server = read_server(directory, namespace)
        except BrokenFile as error:
            if on_broken is None:
                raise
            on_broken(error.reason)
            server = None
        if server is None:
            missing.append(namespace)
        else:
            found.append(server)
        if missing and not found:
            break
    return Configuration(tuple(found), tuple(missing), directory)


# --- files


def safe_name(name: str) -> str:
    """A port or namespace name as part of a file name or of an environment variable.

    >>> safe_name("/env/ns")
    '_env_ns'
    """
    return _UNSAFE.sub("_", name)


def namespace_file(directory: Path) -> Path:
    return directory / "yarp_namespace.conf"


def server_file(directory: Path, namespace: str) -> Path:
    """The address file of a namespace."""
    name = "yarp" if namespace == ROOT else safe_name(namespace)
    return directory / f"{name}.conf"


# --- namespaces


def namespaces(environment: Mapping[str, str], directory: Path | None = None) -> list[str]:
    """The namespaces in use, the current one first; `["/root"]` by default."""
    from yarpy.data.bottle import Bottle

    directory = conf_directory(environment) if directory is None else directory
    text = environment.get("YARP_NAMESPACE") or _read(namespace_file(directory))
    found = [item if isinstance(item, str) else str(item) for item in Bottle.from_text(text)]
    return [name for name in found if name] or [ROOT]


def write_namespaces(directory: Path, names: Sequence[str]) -> Path:
    """Store the namespaces as `yarp namespace` does; returns the file."""
    from yarpy.data.bottle import Bottle

    path = namespace_file(directory)
    _write(path, Bottle(names).to_text())
    return path


# --- addresses


def read_server(directory: Path, namespace: str = ROOT) -> Server | None:
    """The stored address of a namespace, or None. Raises BrokenFile for one without an address."""
    path = server_file(directory, namespace)
    try:
        server = parse_server(_read(path))
    except AddressError as error:
        raise BrokenFile(f"{path}: {error}") from None
    if server is None:
        return None
    return Server(server.host, server.port, server.mode, namespace, path)


def write_server(directory: Path, server: Server) -> Path:
    """Store an address where C++ YARP finds it too; returns the file."""
    path = server_file(directory, server.namespace)
    _write(path, f"{server.host} {server.port} {server.mode}\n")
    return path


def clear_server(directory: Path, namespace: str = ROOT) -> Path:
    """Forget the stored address (`yarp conf --clean`): the file stays, empty."""
    path = server_file(directory, namespace)
    _write(path, "")
    return path


def parse_server(text: str) -> Server | None:
    """The content of an address file: `HOST PORT [MODE]` or the ini form; None if it is empty.

    Raises AddressError for what is no address.

    >>> parse_server("127.0.0.1 10000").mode
    'yarp'
    """
    if text.startswith("["):
        words = _parse_section(text)
    else:
        words = [word for word in re.split(r'[ \t\r\n"]+', text) if word]
    if not words:
        return None
    if len(words) < 2 or not words[0]:
        said = "a section [name] without host" if len(words) > 1 else f'only "{_shown(words[0])}"'
        raise AddressError(f"{said} is no address of a name server, which is HOST PORT")
    mode = words[2] if len(words) > 2 and words[2] else YARP
    mode = YARP if mode == "//" else mode
    if mode not in (YARP, LOCAL) and mode not in names.names():
        known = ", ".join([YARP, LOCAL, *names.names()])
        raise AddressError(f'no mode "{_shown(mode)}" of a name server: use one of {known}')
    number = _number(words[1])
    if mode == YARP and not number:
        raise AddressError(
            f'"{_shown(words[1])}" is no port of a name server, which is a number from 1 to 65535'
        )
    return Server(words[0], number, mode)


def default_port(environment: Mapping[str, str]) -> int:
    """The default port of a name server, and the port of multicast discovery."""
    return _number(environment.get("YARP_PORT_RANGE", "")) or DEFAULT_PORT


# --- ports


def flag(environment: Mapping[str, str], name: str, default: bool) -> bool:
    """A yes or no among the variables; anything else counts as not said."""
    text = environment.get(name, "").lower()
    return text in _YES or (default and text not in _NO)


def port_name(name: str, environment: Mapping[str, str]) -> str:
    """The name under which a port opened as `name` is known: renamed, then prefixed.

    `YARP_RENAME_cam=/eye` renames /cam; `YARP_PORT_PREFIX=/robot` is put before every name.
    """
    renamed = environment.get(f"YARP_RENAME{safe_name(name)}") or name
    return environment.get("YARP_PORT_PREFIX", "") + renamed


def port_number(name: str, environment: Mapping[str, str]) -> int:
    """The TCP port that `YARP_PORTNUMBER_cam=N` gives to /cam, or 0."""
    return _number(environment.get(f"YARP_PORTNUMBER{safe_name(name)}", ""))


# --- inside


def _parse_host_port(text: str, environment: Mapping[str, str]) -> Server:
    """One item of YARPY_SERVER: `host:port`, `host`, `[ipv6]:port`."""
    word, _, place = text.partition("+")
    if word.isidentifier() and word in names.names():
        kind, mark, rest = place.partition("://")
        return Server(f"{kind}/{rest}" if mark and kind != "file" else place, 0, word)
    host, colon, port = text.rpartition(":")
    if text.startswith("[") and text.endswith("]"):
        host, colon, port = text, "", ""
    elif not colon:
        host, port = text, ""
    number = _number(port) if colon else default_port(environment)
    host = host.strip("[]")
    if not host or not number:
        raise AddressError(
            f'YARPY_SERVER="{text}": give HOST:PORT, for example 127.0.0.1:10000, or one '
            f"of {', '.join(names.names())}"
        )
    return Server(host, number)


def _parse_section(text: str) -> list[str]:
    """Host, port and mode of section [name]."""
    fields: dict[str, str] = {}
    section = ""
    found = False
    for line in text.splitlines():
        if line.startswith("["):
            section = line[1:].partition("]")[0].strip()
            found = found or section == "name"
            continue
        words = re.split(r'[ \t"]+', line.partition("//")[0].strip())
        if section == "name" and words[0] and not words[0].startswith("#"):
            fields[words[0]] = words[1] if len(words) > 1 else ""
    if not found:
        raise AddressError("an address file that begins with [ needs a section [name]")
    return [fields.get("host", ""), fields.get("port", ""), fields.get("mode", "")]


def _shown(word: str) -> str:
    """A word of a file as an error shows it: it may be any bytes."""
    return word if word.isprintable() and len(word) < 30 else f"{word[:12]!a}..."


def _number(text: str) -> int:
    """A TCP port number; 0 for anything else."""
    text = text.strip()
    number = int(text) if text.isascii() and text.isdigit() and len(text) < 6 else 0
    return number if number <= 65535 else 0


def _read(path: Path) -> str:
    try:
        return path.read_text("utf-8", "surrogateescape")
    except OSError:
        return ""


def _write(path: Path, text: str) -> None:
    """Replace the file atomically, so that no reader sees half an address."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    try:
        draft.write_text(text, "utf-8", "surrogateescape", newline="\n")
        replace(draft, path)
    except OSError as error:
        error.filename = str(path)  # a full disk does not say which file
        with suppress(OSError):  # on a disk that cannot be written nothing can be taken away
            draft.unlink(missing_ok=True)
        raise
