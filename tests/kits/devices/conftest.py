"""What the tests of devices share: names of their own."""

from __future__ import annotations

import pytest

from yarpy.nameserver.local import LocalNames


@pytest.fixture
def names() -> LocalNames:
    """Names of this test alone, without a server."""
    return LocalNames()
