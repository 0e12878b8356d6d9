"""The suites that ship, on what Zenoh brings."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from typing import Any

import pytest

from yarpy.names.base import NameClient
from yarpy.peers.zenoh.middleware import Zenoh
from yarpy.peers.zenoh.names import ZenohNames
from yarpy.testing import MiddlewareConformance, NamesConformance

pytest.importorskip("zenoh")
_numbers = count(1)


@pytest.fixture(autouse=True)
def _reached(router: str, no_settings: None) -> None:
    """A router of these tests alone."""


class TestZenohNames(NamesConformance):
    @contextmanager
    def opened(self) -> Iterator[NameClient]:
        names = ZenohNames(namespace=f"/suite{next(_numbers)}")
        try:
            yield names
        finally:
            names.close()


class TestZenoh(MiddlewareConformance):
    middleware: Any = Zenoh
