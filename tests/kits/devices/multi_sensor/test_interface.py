from yarpy.kits.devices.multi_sensor.interface import KINDS, MultiSensorLike


def test_every_kind_is_described():
    assert len(KINDS) == 12
    assert set(KINDS) <= set(vars(MultiSensorLike))
    assert KINDS["thermometers"] == 1 and KINDS["force_torques"] == 6
