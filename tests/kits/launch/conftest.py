"""Names for ports of these tests, the command line with a name server and a folder of its own for
sockets, and a guard: what they start hears no signal, or floods, and ends with them even when they
are killed."""

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.commands import here, lone, names, server
from support.guard import guarded

import yarpy

__all__ = ["cli", "here", "lone", "names", "server"]


@pytest.fixture(scope="session", autouse=True)
def guard() -> Iterator[None]:
    """End all programs of these tests with the process of the tests."""
    with guarded():
        yield


@pytest.fixture
def network() -> Iterator[yarpy.LocalNames]:
    """Names that only this test has."""
    yield yarpy.LocalNames()


@pytest.fixture
def runtime(tmp_path, monkeypatch: pytest.MonkeyPatch):
    """Where the sockets of running applications are."""
    monkeypatch.setenv("YARP_RUNTIME_DIR", str(tmp_path / "run"))
    return tmp_path / "run" / "up"


@pytest.fixture(scope="module")
def cli(
    server: yarpy.NameServer, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[CommandLine]:
    """The command in processes of its own, using the server; other tests have other sockets."""
    run = Path(tempfile.mkdtemp(prefix="yarpy-up-"))  # a path of a socket is short
    home = tmp_path_factory.mktemp("home")
    yield CommandLine(home, {**server.environment, "YARP_RUNTIME_DIR": str(run)})
    shutil.rmtree(run)
