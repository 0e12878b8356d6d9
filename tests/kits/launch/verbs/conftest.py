"""The command line, a name server that it uses, and a place for its sockets."""

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.commands import here, lone, names, server

import yarpy

__all__ = ["cli", "here", "lone", "names", "server"]


@pytest.fixture(scope="module")
def cli(
    server: yarpy.NameServer, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[CommandLine]:
    """The command in processes of its own, using the server; other tests have other sockets."""
    run = Path(tempfile.mkdtemp(prefix="yarpy-up-"))  # a path of a socket is short
    home = tmp_path_factory.mktemp("home")
    yield CommandLine(home, {**server.environment, "YARP_RUNTIME_DIR": str(run)})
    shutil.rmtree(run)
