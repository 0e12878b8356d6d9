"""Private names: the default inside the block, gone after it."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from yarpy.errors import NoNameServer, YarpError
from yarpy.names.default import DEFAULT
from yarpy.network import exists, query
from yarpy.port.port import Port
from yarpy.testing import private_names, private_server


def test_private_names_are_the_default_inside() -> None:
    with private_names() as names:
        assert DEFAULT.current() is names
        with Port("/a") as port:
            found = query("/a")
            assert found is not None
            assert found.port == port.contact.port
            with private_names():
                assert query("/a") is None
            assert exists("/a")
    try:
        assert DEFAULT.current() is not names
    except NoNameServer:
        pass  # this machine has none configured


def test_private_names_go_with_an_error_too() -> None:
    with pytest.raises(ZeroDivisionError), private_names() as names:
        raise ZeroDivisionError
    try:
        assert DEFAULT.current() is not names
    except YarpError:
        pass


def test_private_server_serves_child_processes() -> None:
    code = "import yarpy; print(yarpy.query('/mine'))"
    with private_server() as server, Port("/mine") as port:
        done = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, **server.environment},
            capture_output=True,
            text=True,
            timeout=20,
        )
        assert done.stdout.strip() == "tcp://mine", done.stderr
        assert query("/mine") == port.contact
