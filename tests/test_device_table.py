"""The table of device interfaces is that of today, and says something of each."""

from support import device_table

from yarpy.kits.devices.interfaces import interfaces


def test_the_table_is_current() -> None:
    assert device_table.PAGE.read_text() == device_table.page(), (
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
