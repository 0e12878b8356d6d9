"""A MuJoCo model for those who ask; without MuJoCo their tests skip."""

from pathlib import Path

import pytest

from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.mujoco.model import mujoco

MODELS = Path(__file__).parents[2] / "support"


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
    """The file of a model that stands."""
    return _model("arm.xml")


@pytest.fixture
def rover() -> Path:
    """The file of a model that moves freely."""
    return _model("rover.xml")


def _model(name: str) -> Path:
    try:
        mujoco()
    except UnknownPlugin as error:
        pytest.skip(str(error))
    return MODELS / name
