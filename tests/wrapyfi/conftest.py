"""`import wrapyfi` of this checkout, for this process; nothing has to be installed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import yarpy
from yarpy.names.default import DEFAULT

SOURCE = Path(__file__).parents[2] / "compat" / "wrapyfi" / "src"
sys.path.insert(0, str(SOURCE))


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    """A name service that all ports use which are given none."""
    local = yarpy.LocalNames()
    DEFAULT.push(local)
    yield local
    DEFAULT.pop(local)
