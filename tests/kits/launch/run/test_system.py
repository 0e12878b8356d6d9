"""What a server says of its computer."""

import struct

import pytest

from yarpy.kits.launch.run import system


def test_every_field_in_its_order(monkeypatch: pytest.MonkeyPatch) -> None:
    facts = {name: number if kind != "s" else f"text {number}"
             for number, (name, kind) in enumerate(system.FIELDS)}  # fmt: skip
    monkeypatch.setattr(system, "_facts", lambda: facts)
    data = bytes(system.described().data)
    assert struct.unpack_from("<4i", data) == (0, 1, 2, 3)
    texts = b"text 4\r\ntext 5\r\ntext 6\r\n"
    assert data[16:].startswith(texts + struct.pack("<4id", 7, 8, 9, 10, 11))
    assert data.endswith(b"text 24\r\n" + struct.pack("<i", 25))


def test_of_this_computer() -> None:
    found = system._facts()
    assert set(found) <= {name for name, _ in system.FIELDS}
    assert int(found["disk total"]) > 0 and found["system"] and int(found["siblings"]) > 0
