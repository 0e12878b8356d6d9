"""`yarpy.testing.names` as pytest fixtures: import them into a `conftest.py`.

from yarpy.testing.fixture import name_server, names
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.testing.names import private_names, private_server


@pytest.fixture
def names() -> Iterator[LocalNames]:
    """Names private to this test; ports that it opens use them by default."""
    with private_names() as found:
        yield found


@pytest.fixture
def name_server() -> Iterator[NameServer]:
    """A name server private to this test, the default while the test runs."""
    with private_server() as server:
        yield server
