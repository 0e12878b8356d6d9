"""A network of its own for each test: names within the process."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import yarpy
from yarpy.names.default import DEFAULT
from yarpy.wrap import setting


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    """A name service that all ports use which are given none."""
    local = yarpy.LocalNames()
    DEFAULT.push(local)
    yield local
    DEFAULT.pop(local)


@pytest.fixture(autouse=True)
def no_settings() -> Iterator[None]:
    """What a test configures ends with it."""
    yield
    setting._settings.clear()
