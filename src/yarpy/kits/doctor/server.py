"""Findings about name servers: there is none, there are two, or it is another than was meant.

Rules: for each server the doctor says who said so: the file and its line, or the environment.
"""

from __future__ import annotations

from collections.abc import Iterator

from yarpy.config.configuration import Server, namespace_file, namespaces, server_file
from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import Finding
from yarpy.platform.folders import conf_directory
from yarpy.platform.shell import no_setting, setting


def find(case: Case) -> Iterator[Finding]:
    """no-server, two-servers, other-namespace."""
    if case.problem is not None:
        yield _no_server(case)
        return
    used = case.servers[0] if case.servers else None
    elsewhere = _elsewhere(case)
    yield from elsewhere
    if used is None or elsewhere or (case.wanted and all(map(case.port, case.wanted))):
        return  # where all is found, it does no harm just now
    for other in case.others:
        if other.namespace == used.namespace and not _is_same(case, other):
            yield Finding(
                "two-servers",
                f"{used.namespace}",
                f"two name servers answer for {used.namespace}: {_place(used)}, which is used here "
                f"({said_by(case, used)}), and {_place(other)}, which also is in this network; a "
                "program that uses the one does not find the ports of the other",
                f"end one of them, or choose the right one: `{_choice(used, other)}`",
                "warning",
            )


def _no_server(case: Case) -> Finding:
    used = case.servers[0] if case.servers else None
    others = [one for one in case.others if _lives(case, one)]
    if used is None:
        about = "name server"
        if case.configuration is None:
            verdict = str(case.problem)
        else:
            namespace = case.configuration.namespace
            path = server_file(case.configuration.directory, namespace)
            verdict = (
                f"no name server is configured for {namespace}: neither YARPY_SERVER nor {path} "
                "says where it is"
            )
    else:
        about = _place(used)
        verdict = (
            f"no name server answers at {_place(used)}, where {said_by(case, used)} says that it is"
        )
    if others:
        other = others[0]
        verdict += f"; one of {other.namespace} answers at {_place(other)}"
        if used is None or used.path is None or other.namespace == used.namespace:
            advice = f"`{_choice(used, other)}`"
        else:
            advice = f"`yarpy namespace {other.namespace}`"
        return Finding("no-server", about, verdict, advice)
    advice = "start one: `yarpy server`, or search for one: `yarpy detect --write`"
    if used is not None and used.path is None:
        advice += f"; or `{no_setting('YARPY_SERVER')}`, which overrides the files"
    return Finding("no-server", about, verdict, advice)


def _elsewhere(case: Case) -> list[Finding]:
    """Names that are unknown here and known to another server."""
    missing = [name for name in case.wanted if name not in case.contacts and _is_name(name)]
    found: list[Finding] = []
    if not missing:
        return found
    for other in case.others:
        for name in list(missing):
            contact = _ask(case, other, name)
            if contact is None:
                continue
            missing.remove(name)
            used = case.servers[0] if case.servers else None
            here = (
                f"{used.namespace} at {_place(used)} ({said_by(case, used)})"
                if used is not None
                else "another one"
            )
            same = used is not None and used.namespace == other.namespace
            found.append(
                Finding(
                    "other-namespace",
                    name,
                    f'"{name}" is known to the name server of {other.namespace} at '
                    f"{_place(other)}, while this shell asks that of {here}",
                    f"`{_choice(used, other)}`"
                    if same
                    else f"`yarpy namespace {other.namespace}`"
                    + ("" if other.path else f" and `yarpy conf {other.host} {other.port}`"),
                )
            )
    return found


def _choice(used: Server | None, other: Server) -> str:
    """Return the command that chooses another server: where the environment says which is used, no
    file would be read."""
    if used is not None and used.path is None:
        return setting("YARPY_SERVER", _place(other))
    return f"yarpy conf {other.host} {other.port}"


def _ask(case: Case, server: Server, name: str) -> Contact | None:
    client = case.server_of(server)
    try:
        return client.query(name)
    except (YarpError, OSError):
        return None
    finally:
        client.close()


def _lives(case: Case, server: Server) -> bool:
    client = case.server_of(server)
    try:
        return client.alive()
    finally:
        client.close()


def _is_same(case: Case, other: Server) -> bool:
    """Return whether a server is the one in use, under another of its addresses, or has gone."""
    if not _lives(case, other):
        return True
    namespace = other.namespace
    ours = case.contacts.get(namespace)
    theirs = _ask(case, other, namespace)
    return ours is not None and theirs is not None and ours == theirs


def _is_name(text: str) -> bool:
    return text.startswith("/")


def _place(server: Server) -> str:
    return f"{server.host}:{server.port}"


def said_by(case: Case, server: Server) -> str:
    """Return what names this server: a file with its line, or the environment."""
    if server.path is None:
        return "the environment variable YARPY_SERVER"
    directory = conf_directory(case.environment)
    path, word = server.path, server.host
    if server.namespace != "/root" and namespaces(case.environment, directory) != ["/root"]:
        if case.environment.get("YARP_NAMESPACE"):
            return f"YARP_NAMESPACE={server.namespace} and {line_of(str(path), word)}"
        return (
            f"{line_of(str(namespace_file(directory)), server.namespace)} and "
            f"{line_of(str(path), word)}"
        )
    return line_of(str(path), word)


def line_of(path: str, word: str) -> str:
    """A file and the first line of it that has `word` in it."""
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            lines = file.read(1 << 16).splitlines()
    except OSError:
        return path
    number = next((number for number, line in enumerate(lines, 1) if word in line), 1)
    return f"{path}, line {number}"
