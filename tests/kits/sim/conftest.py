"""A MuJoCo model for those who ask; without MuJoCo their tests skip."""

from pathlib import Path

import pytest

from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.mujoco.model import mujoco

ARM = Path(__file__).parents[2] / "support" / "arm.xml"


class Clock:
    """Time that a test lets pass."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def arm() -> Path:
    """The file of the model."""
    try:
        mujoco()
    except UnknownPlugin as error:
        pytest.skip(str(error))
    return ARM
