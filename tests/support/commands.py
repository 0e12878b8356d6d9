"""A name server of its own for every file of tests, and the command line that uses it."""

import json
import logging
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from support.command_line import CommandLine
from support.port import free_port

import yarpy

PYTHON = json.dumps(sys.executable)  # as TOML has it
#: a program of an application that runs until it is ended, on any system
SLEEP = f"{{command = [{PYTHON}, '-c', 'import time; time.sleep(600)']}}"


@pytest.fixture(scope="module")
def server() -> Iterator[yarpy.NameServer]:
    """Not the default of this process: other tests share it."""
    server = yarpy.NameServer()
    yield server
    server.close()


@pytest.fixture(scope="module")
def names(server: yarpy.NameServer) -> yarpy.YarpNameClient:
    """For ports of the test itself: `yarpy.Port("/x", names=names)`."""
    return server.client


@pytest.fixture(scope="module")
def cli(server: yarpy.NameServer, tmp_path_factory: pytest.TempPathFactory) -> CommandLine:
    """The command in processes of its own, using the server."""
    return CommandLine(tmp_path_factory.mktemp("home"), server.environment)


@pytest.fixture
def lone(tmp_path: Path) -> CommandLine:
    """The command where no server is configured, and none can be found."""
    return CommandLine(tmp_path, {"YARP_PORT_RANGE": str(free_port())})


class Said(NamedTuple):
    code: int
    out: str
    err: str


@pytest.fixture
def here(
    server: yarpy.NameServer,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> Iterator[Callable[..., Said]]:
    """The command in this process, for what needs no other: `here("exists", "/x")`."""
    from yarpy.cli.main import run

    for name in [name for name in os.environ if name.startswith(("YARP_", "YARPY_"))]:
        monkeypatch.delenv(name)
    for name, value in server.environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("YARP_DATA_HOME", str(tmp_path / "data"))
    logger = logging.getLogger("yarpy")
    before = list(logger.handlers), logger.level, logger.propagate

    def say(*words: str) -> Said:
        capsys.readouterr()
        code = run(words)
        return Said(code, *capsys.readouterr())

    yield say
    logger.handlers, logger.level, logger.propagate = before
