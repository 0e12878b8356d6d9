"""Devices that are not installed."""

from pathlib import Path

import pytest

from yarpy.kits.launch.robot.checking import unknown_types
from yarpy.kits.launch.robot.robot_file import load


@pytest.mark.parametrize(
    ("type_", "said"),
    [
        ("simulatedHead", None),
        ("simulatedHaed", 'is installed: did you mean "simulatedHead"?'),
        ("controlboardcoupling", "is installed"),  # like others, and no slip
    ],
)
def test_types(tmp_path: Path, type_: str, said: str | None) -> None:
    file = tmp_path / "r.xml"
    file.write_text(
        f'<robot name="r" portprefix="/r" build="0"><device name="d" type="{type_}"/></robot>'
    )
    found = [*unknown_types(load(file))]
    assert (said is None) == (not found)
    if said is not None:
        assert found[0].fatal and found[0].text.endswith(said)
