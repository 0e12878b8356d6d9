"""Names within this process."""

import pytest

from yarpy import LocalNames


@pytest.fixture
def names() -> LocalNames:
    return LocalNames()
