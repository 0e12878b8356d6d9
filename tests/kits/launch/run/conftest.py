"""What the tests of `run` share: names of their own, and servers that leave nothing behind."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from yarpy.kits.launch.run.client import RunClient
from yarpy.kits.launch.run.server import RunServer
from yarpy.kits.launch.supervise import process
from yarpy.nameserver.local import LocalNames

Serve = Callable[..., RunServer]


@pytest.fixture
def names() -> LocalNames:
    """Names of this test alone, without a server."""
    return LocalNames()


@pytest.fixture
def serve(names: LocalNames, tmp_path: Path) -> Iterator[Serve]:
    """Make servers called /node, one after the other; what they started ends with the test."""
    made: list[RunServer] = []

    def make(**options: object) -> RunServer:
        server = RunServer("/node", folder=tmp_path, names=names, **options)  # type: ignore[arg-type]
        made.append(server)
        return server

    yield make
    trees = [one.process_tree for server in made for one in server.programs]
    for server in made:
        if not server._closing.is_set():
            server.close()
    for process_tree in trees:
        while process_tree.members():
            process_tree.signal(signal.SIGKILL)


@pytest.fixture
def node(serve: Serve, names: LocalNames) -> Iterator[RunClient]:
    """A client of a server that has no options."""
    if not process.known():
        pytest.skip("this system has no /proc to look at")
    serve()
    with RunClient("/node", names=names) as client:
        yield client
