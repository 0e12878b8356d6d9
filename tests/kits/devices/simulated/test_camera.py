"""A camera without hardware."""

from yarpy.kits.devices.simulated.camera import SimulatedCamera


def test_a_line_goes_down() -> None:
    camera = SimulatedCamera(32, 24)
    picture = camera.image()
    assert picture.shape == (24, 32, 3)
    assert picture.max() == 255 and (picture[:, 0, 0] == 255).sum() == 1
