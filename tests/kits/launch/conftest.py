"""Names for ports of these tests, a folder of their own for sockets, and a guard: what they start
hears no signal, or floods, and ends with them even when they are killed."""

from collections.abc import Iterator

import pytest
from support.guard import guarded

import yarpy


@pytest.fixture(scope="session", autouse=True)
def guard() -> Iterator[None]:
    """End all programs of these tests with the process of the tests."""
    with guarded():
        yield


@pytest.fixture
def network() -> Iterator[yarpy.LocalNames]:
    """Names that only this test has."""
    yield yarpy.LocalNames()


@pytest.fixture
def runtime(tmp_path, monkeypatch: pytest.MonkeyPatch):
    """Where the sockets of running applications are."""
    monkeypatch.setenv("YARP_RUNTIME_DIR", str(tmp_path / "run"))
    return tmp_path / "run" / "up"
