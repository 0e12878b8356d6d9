"""What tests of decorators need: names within the process, and settings that end with the test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import yarpy
from yarpy.kits.wrap import setting
from yarpy.names.default import DEFAULT


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
