"""Pictures of a MuJoCo model, where something can draw them."""

import numpy as np
import pytest
from support.peer import brings

from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.mujoco import camera
from yarpy.kits.sim.mujoco.camera import FREE, Camera, Painter
from yarpy.kits.sim.mujoco.model import load


@pytest.fixture
def model(arm, clock):
    return load(arm, clock)


@pytest.fixture
@brings("gl")
def painter(model):
    painter = Painter(model, 80, 60)
    yield painter
    painter.close()


def test_pictures(model, painter, clock):
    cameras = [Camera(painter, model.model, number) for number in (0, 1, FREE)]
    clock.now += 0.01
    images = [camera.image() for camera in cameras]
    for image in images:
        assert (image.width, image.height, image.code) == (80, 60, "rgb")
    assert len(np.unique(images[0].array)) > 10
    assert images[0] != images[1] != images[2]
    assert cameras[0].timestamp() == clock.now
    kept = images[0].array.copy()
    with model.present() as joints:
        joints[0].reference.move_to(80.0)
    for _ in range(100):
        clock.now += 0.02
        with model.present():
            pass
    later = cameras[0].image()
    assert (later.array != kept).any(-1).mean() > 0.005
    assert (images[0].array == kept).all(), "each picture has memory of its own"


def test_field_of_view(model, painter):
    assert Camera(painter, model.model, 1).field_of_view == pytest.approx((75.2, 60.0), abs=0.1)


@pytest.mark.peer("gl")
def test_larger_than_the_model_says(model):
    painter = Painter(model, 800, 500)
    assert Camera(painter, model.model, 0).image().array.shape == (500, 800, 3)
    painter.close()


def test_where_nothing_can_draw(model, monkeypatch):
    """MuJoCo is not asked twice: the second time it would wait for ever."""
    asked = []

    class Blind:
        def __init__(self, *arguments):
            asked.append(arguments)
            raise RuntimeError("no display")

    monkeypatch.setattr(camera.mujoco(), "Renderer", Blind)
    monkeypatch.setattr(Painter, "_spoiled", "")
    for _ in range(2):
        with pytest.raises(UnknownPlugin, match=r"libegl1 .*no display"):
            Painter(model, 80, 60)
    assert len(asked) == 1
