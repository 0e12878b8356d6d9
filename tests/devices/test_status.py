from yarpy.devices.status import FAILED, MISSING, OK, reason


def test_reasons() -> None:
    assert OK == "ok" and reason(MISSING) == "it cannot do this"
    assert reason(FAILED) == "it cannot do this, or not with these values"
    assert reason("odd") == "it says odd"
