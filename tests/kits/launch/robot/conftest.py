"""Files of robots for these tests."""

from collections.abc import Callable
from pathlib import Path

import pytest

DOCTYPE = (
    '<!DOCTYPE robot PUBLIC "-//YARP//DTD yarprobotinterface 3.0//EN" '
    '"http://www.yarp.it/DTD/yarprobotinterfaceV3.0.dtd">'
)

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write the inside of a robot's file, or a whole other one, and return its path."""

    def written(text: str, name: str = "robot.xml", *, whole: bool = False, head: str = "") -> Path:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True, parents=True)
        if not whole:
            text = f'{DOCTYPE}\n<robot name="r" portprefix="/r" {head}>\n{text}\n</robot>\n'
        path.write_text(text)
        return path

    return written
