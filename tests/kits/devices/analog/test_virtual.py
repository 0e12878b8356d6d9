"""Estimated torques for devices that measure none."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.wait import wait_until

import yarpy
from yarpy.kits.devices.analog.virtual import Network, VirtualAnalogServer
from yarpy.nameserver.local import LocalNames


class Motors:
    def __init__(self) -> None:
        self.told: list[list[float]] = []

    def update_measures(self, values: list[float]) -> None:
        self.told.append(values)


@pytest.fixture
def upper() -> Motors:
    return Motors()


@pytest.fixture
def lower() -> Motors:
    return Motors()


@pytest.fixture
def port(upper: Motors, lower: Motors, names: LocalNames) -> Iterator[yarpy.Port]:
    networks = {"up": Network(0, 3, 0, 3), "low": Network(4, 5, 2, 3)}
    with (
        VirtualAnalogServer("/torques:i", {"up": upper, "low": lower}, networks, names=names),
        yarpy.Port("/estimates", names=names) as port,
    ):
        port.connect("/torques:i")
        yield port


@pytest.mark.parametrize(
    ("told", "up", "low"),
    [
        ("1 1.0 2.0 3.0 4.0 5.0", [1.0, 2.0, 3.0, 4.0], [5.0, 0.0]),
        ("2 1.0 2.0 3.0 4.0 5.0 6.0", [1.0, 2.0, 3.0, 4.0], [5.0, 6.0]),
        ("3 1.0 2.0 3.0 4.0 5.0 6.0 7.0", [6.0, 7.0, 0.0, 0.0], [0.0, 0.0]),
        ("4 1.0 2.0 3.0", [1.0, 2.0, 3.0, 0.0], [0.0, 0.0]),
        ("1 1.5", [1.5, 0.0, 0.0, 0.0], [0.0, 0.0]),
    ],
)
def test_each_part_of_a_body(
    port: yarpy.Port, upper: Motors, lower: Motors, told: str, up: list[float], low: list[float]
) -> None:
    port.write(yarpy.Bottle.from_text(told))
    wait_until(lambda: upper.told and lower.told)
    assert upper.told[0] == up and lower.told[0] == low


def test_zeros_once_nothing_comes_any_more(port: yarpy.Port, upper: Motors, lower: Motors) -> None:
    for _ in range(2):  # and again after it had fallen silent
        before = len(upper.told)
        port.write(yarpy.Bottle.from_text("2 1 2 3 4 5 6"))
        wait_until(lambda before=before: len(upper.told) == before + 2)
        assert upper.told[-2:] == [[1.0, 2.0, 3.0, 4.0], [0.0] * 4]
        wait_until(lambda: lower.told[-1] == [0.0, 0.0])


def test_what_is_no_list_of_torques_changes_nothing(
    port: yarpy.Port, upper: Motors, caplog: pytest.LogCaptureFixture
) -> None:
    for text in ("9 1.0", "", "2 much"):
        port.write(yarpy.Bottle.from_text(text))
    port.write(yarpy.Bottle.from_text("4 1.0"))
    wait_until(lambda: upper.told)
    assert upper.told[0] == [1.0, 0.0, 0.0, 0.0]
    assert "the first number says of what it is" in caplog.text


def test_channels_that_no_network_has(
    names: LocalNames, upper: Motors, caplog: pytest.LogCaptureFixture
) -> None:
    few = {"up": Network(0, 2, 0, 2)}
    with (
        VirtualAnalogServer("/torques:i", {"up": upper}, few, names=names),
        yarpy.Port("/estimates", names=names) as port,
    ):
        port.connect("/torques:i")
        port.write(yarpy.Bottle.from_text("1 1 2 3 4 5"))
        port.write(yarpy.Bottle.from_text("4 1 2 3"))
        wait_until(lambda: upper.told)
    assert upper.told[0] == [1.0, 2.0, 3.0]
    assert "no network has the channel 3" in caplog.text


def test_devices_that_cannot_be_told(names: LocalNames) -> None:
    networks = {"up": Network(0, 2, 0, 2)}
    with pytest.raises(ValueError, match="up is not attached"):
        VirtualAnalogServer("/x", {}, networks, names=names)
    with pytest.raises(ValueError, match="up has no update_measures"):
        VirtualAnalogServer("/x", {"up": object()}, networks, names=names)
