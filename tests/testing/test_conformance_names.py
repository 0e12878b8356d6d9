"""The suite for name clients, on those of the core; guests have it in their own folders."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

import yarpy
from yarpy.names.base import NameClient
from yarpy.names.fallback_client import SeveralNames
from yarpy.testing import NamesConformance


class TestLocalNames(NamesConformance):
    @contextmanager
    def opened(self) -> Iterator[NameClient]:
        yield yarpy.LocalNames()


class TestYarpNameClient(NamesConformance):
    @contextmanager
    def opened(self) -> Iterator[NameClient]:
        with yarpy.NameServer() as server:
            yield server.client


class TestSeveralNames(NamesConformance):
    @contextmanager
    def opened(self) -> Iterator[NameClient]:
        with yarpy.NameServer() as server:
            yield SeveralNames([server.client, yarpy.LocalNames()])


class Forgetful(yarpy.LocalNames):
    """Registers and knows nothing."""

    def query(self, name: str) -> yarpy.Contact | None:
        return None


def test_a_client_that_forgets_is_caught() -> None:
    class Suite(NamesConformance):
        @contextmanager
        def opened(self) -> Iterator[NameClient]:
            yield Forgetful()

    for failing in ("test_finds_what_was_registered", "test_lets_ports_meet"):
        with pytest.raises((AssertionError, yarpy.YarpError)):
            getattr(Suite(), failing)()


def test_opened_has_to_be_written() -> None:
    with pytest.raises(NotImplementedError, match="write opened"):
        NamesConformance().test_has_every_member()
