"""The library of DDS, where it is missing."""

import sys

import pytest

from yarpy.errors import UnknownPlugin
from yarpy.peers.ros2.dds.library import delete, load


def test_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    assert load().__name__ == "cyclonedds.core"
    monkeypatch.setitem(sys.modules, "cyclonedds.core", None)
    with pytest.raises(UnknownPlugin, match=r"pip install 'yarpy\[dds\]'"):
        load()


def test_deleted_now() -> None:
    told = []

    class Entity:
        def __del__(self) -> None:
            told.append("deleted")

    held = Entity()
    delete(held)
    assert told == ["deleted"] and held is not None
