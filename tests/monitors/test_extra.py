"""Libraries that are not there."""

from __future__ import annotations

import zlib

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.monitors.extra import needed


def test_a_module_that_is_there() -> None:
    assert needed("zlib", "none", "this test") is zlib


def test_one_that_is_not_names_the_extra() -> None:
    with pytest.raises(LocalProtocolError, match=r'^this test .*"no_such".*"yarpy\[some\]"'):
        needed("no_such", "some", "this test")
