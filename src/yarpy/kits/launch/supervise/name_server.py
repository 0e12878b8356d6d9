"""A name server for an application that finds none.

Rules: it is for this computer alone, and ends with the application. Programs find it by their
environment, so nothing is written to the configuration. Applications without connections and needs
may do without one, and are told nothing.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

import yarpy
from yarpy.config.configuration import default_port
from yarpy.kits.launch.application.application import Application
from yarpy.platform.shell import setting
from yarpy.transports.bind import SETTING


@contextmanager
def name_server(application: Application, bring: bool) -> Iterator[str]:
    """Give what is to be said about the name server, "" if one answers; with `bring`, open one
    meanwhile where none does."""
    why = missing()
    if not why:
        yield ""
    elif bring:
        yield from _brought()
    elif application.connections or application.needs or any(m.needs for m in application.modules):
        yield f"{why}; or bring one along with --server"
    else:
        yield ""


def missing() -> str:
    """Return why there is no name server, "" if there is one."""
    try:
        yarpy.query("/yarpy/up")  # any name
    except (yarpy.NoNameServer, yarpy.Timeout) as error:
        return str(error)
    return ""


def _brought() -> Iterator[str]:
    before = {name: os.environ.get(name) for name in (SETTING, "YARPY_SERVER")}
    os.environ[SETTING] = "local"
    try:
        with _opened() as server:
            os.environ.update(server.environment)
            yield (
                f"a name server of its own is at {server.address} until the end; "
                f"in other terminals: {setting('YARPY_SERVER', server.address)}"
            )
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _opened() -> yarpy.NameServer:
    try:
        return yarpy.NameServer(default_port(os.environ))
    except yarpy.AddressError:  # somebody has the usual number
        return yarpy.NameServer()
