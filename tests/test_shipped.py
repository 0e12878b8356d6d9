"""The rows of what ships with yarpy say what the classes say."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from support.table import for_each

from yarpy import registry
from yarpy.facts import CarrierRow, Row
from yarpy.shipped import CARRIERS, ELSEWHERE, SHIPPED
from yarpy.wire import framing

ROOT = Path(__file__).parents[1]
ROWS = [(kind, row) for kind, rows in SHIPPED.items() for row in rows.values()]
BEGINNINGS = [
    *(row.magic for row in CARRIERS.values()),
    *((framing.number(framing.BASE + code),) for code in range(-2, 1030)),
    *((bytes([0x10, size, 0, 4]) + b"MQTT",) for size in range(256)),
    *((bytes([0x10, size, 1, 0, 4]) + b"MQT",) for size in range(256)),
    *((method + b" /abcdefgh",) for method in (b"GET", b"POST", b"HEAD", b"PUT", b"DELETE")),
    (b"PATCH /x", b"OPTIONS ", b"POST /fo", b"POST /RP", b"POST / H", b"GARBAGE!", bytes(8)),
    *(
        (whole.to_bytes(4, "little") + field.to_bytes(4, "little"),)
        for whole in (0, 6, 40, 300, 70_000, 1 << 20, (1 << 20) + 1, 1 << 31)
        for field in (0, 1, 2, 39, 300, 66_000, 1 << 20, 1 << 31)
    ),
]


@pytest.mark.parametrize("row", CARRIERS.values(), ids=CARRIERS)
def test_a_row_says_what_its_class_says(row: CarrierRow) -> None:
    kind = registry.carriers.load(row.name)
    said = replace(CarrierRow.of(row.name, kind), extra=row.extra, magic=row.magic, mask=row.mask)
    assert replace(said, target=row.target) == row
    assert kind.name == row.name


@pytest.mark.parametrize("row", CARRIERS.values(), ids=CARRIERS)
def test_what_a_class_recognises_its_row_lets_pass(row: CarrierRow) -> None:
    kind = registry.carriers.load(row.name)
    seen = [first[:8].ljust(8, b"\0") for group in BEGINNINGS for first in group]
    taken = [first for first in seen if kind.recognises(first)]
    assert [first for first in taken if not row.may_begin(first)] == []
    assert bool(taken) == bool(row.magic), "its magic is in the row, and only that"


SAID = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


@for_each(ROWS)
def test_what_ships_has_a_home_and_an_extra(named: tuple[str, Row]) -> None:
    kind, row = named
    assert row.home
    assert row.extra in ("", *SAID["optional-dependencies"])
    assert f"yarpy.{kind}" in SAID["entry-points"], "a stranger's would not be found"


def test_what_is_elsewhere_is_not_here() -> None:
    assert not ELSEWHERE.keys() & CARRIERS.keys()
    assert not any(row.target for row in ELSEWHERE.values())
