"""How many connections are served, of a port and of an address."""

from __future__ import annotations

import pytest

from yarpy.link.begin.occupancy import DEFAULT, SETTING, Occupancy, connections, is_here


@pytest.fixture
def door(monkeypatch: pytest.MonkeyPatch) -> Occupancy:
    monkeypatch.setenv(SETTING, "8")
    return Occupancy("/here")


def test_address_has_a_quarter(door: Occupancy, caplog: pytest.LogCaptureFixture) -> None:
    assert door.admit("10.0.0.1")
    assert door.admit("10.0.0.1")
    assert not door.admit("10.0.0.1")
    assert not door.admit("10.0.0.1")
    assert door.admit("10.0.0.2")
    assert door.total == 3
    assert caplog.text.count("10.0.0.1") == 1
    door.leave("10.0.0.1")
    door.leave("10.0.0.1")
    assert "takes connections again" in caplog.text
    assert door.admit("10.0.0.1")


def test_programs_of_this_computer_share_the_port(door: Occupancy) -> None:
    assert [door.admit("127.0.0.1") for _ in range(9)] == [True] * 8 + [False]
    assert not door.admit("10.0.0.1")
    door.leave("127.0.0.1")
    assert door.admit("10.0.0.1")


def test_setting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(SETTING, raising=False)
    assert connections() == DEFAULT
    monkeypatch.setenv(SETTING, "0")
    assert connections() == 1


@pytest.mark.parametrize(
    ("address", "here"),
    [("127.0.0.5", True), ("::1", True), ("12.7.0.1", False), ("fe80::1", False)],
)
def test_addresses_of_this_computer(address: str, here: bool) -> None:
    assert is_here(address) is here
