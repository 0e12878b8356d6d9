"""Names for tests: private to this process, or on a name server that nobody else uses.

Rules: inside the `with` they are this process's default, so ports use them without arguments; they
can be nested, and the innermost counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from yarpy.names.default import DEFAULT
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer


@contextmanager
def private_names() -> Iterator[LocalNames]:
    """Names inside this process, without any server.

    with private_names(), Port("/a") as a, Port("/b") as b: ...
    """
    names = LocalNames()
    DEFAULT.push(names)
    try:
        yield names
    finally:
        DEFAULT.pop(names)


@contextmanager
def private_server() -> Iterator[NameServer]:
    """A name server on a free port number of the loopback, closed at the end.

    Its `environment` makes child processes use it: `{**os.environ, **server.environment}`.
    """
    with NameServer() as server:
        yield server
