"""The tables of device interfaces are those of today, and say something of each."""

import json

from support import device_table, device_times

from yarpy.kits.devices.interfaces import interfaces


def test_the_table_is_current() -> None:
    assert device_table.PAGE.read_text(encoding="utf-8") == device_table.page(), (
        "docs/devices.md is older than the code: python tests/support/device_table.py"
    )


def test_every_interface_has_one_row() -> None:
    assert len(device_table.NAMES) == len({*device_table.NAMES})
    made = {name for *_, has in device_table.OWN for name in has.split()}
    made |= {each.VIEW or "INavigation2DVelocityActions" for each in interfaces().values()}
    made |= {name for has in device_table.ALSO.values() for name in has.split()}
    assert made <= {*device_table.NAMES}
    assert not made & device_table.WHY.keys()
    assert made | device_table.WHY.keys() == {*device_table.NAMES}


def test_each_device_was_measured_or_has_no_halves() -> None:
    kept = json.loads(device_times.KEPT.read_text(encoding="utf-8"))
    measured = {name for each in kept.values() for name in each["rows"]}
    measured |= {row["streams"] for each in kept.values() for row in each["rows"].values()} - {""}
    assert measured <= {*device_table.NAMES}
    assert not measured & device_times.WITHOUT.keys()
    said = measured | device_times.WITHOUT.keys()
    known: dict[str, set[str]] = {}
    for name, *_, has in device_table.OWN:
        known.setdefault(name, set()).update(has.split())
    for name, each in interfaces().items():
        known[name] = {each.VIEW or "INavigation2DVelocityActions"}
    assert [name for name, has in known.items() if not has & said] == []
