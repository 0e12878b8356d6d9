"""Views of sensors: a unit in Python, by itself and behind the server."""

from __future__ import annotations


class Unit:
    frames = {"imu": "head"}

    def gyroscopes(self) -> dict[str, tuple[float, ...]]:
        return {"imu": (0.0, 0.1, 0.2), "second": (1.0, 1.1, 1.2)}

    def thermometers(self) -> dict[str, float]:
        return {"chip": 41.5}

    def skin_patches(self) -> dict[str, tuple[float, ...]]:
        return {"palm": (1.0, 2.0, 3.0, 4.0)}


def test_unit_in_python() -> None:
    import yarp

    driver = yarp.PolyDriver()
    driver.give(Unit(), True)
    gyroscopes, out = driver.viewIThreeAxisGyroscopes(), yarp.Vector()
    assert gyroscopes.getNrOfThreeAxisGyroscopes() == 2
    assert gyroscopes.getThreeAxisGyroscopeName(1) == "second"
    assert gyroscopes.getThreeAxisGyroscopeFrameName(0) == "head"
    assert gyroscopes.getThreeAxisGyroscopeFrameName(1) == "second"
    assert gyroscopes.getThreeAxisGyroscopeName(7) == "unknown"
    assert gyroscopes.getThreeAxisGyroscopeStatus(1) == yarp.MAS_OK
    assert gyroscopes.getThreeAxisGyroscopeStatus(2) == yarp.MAS_ERROR
    assert gyroscopes.getThreeAxisGyroscopeMeasure(1, out) == 0.0 and [*out] == [1.0, 1.1, 1.2]
    assert gyroscopes.getThreeAxisGyroscopeMeasure(-1, out) == -1.0
    assert driver.viewITemperatureSensors().getTemperatureSensorMeasure(0, out) == 0.0
    assert [*out] == [41.5]
    assert driver.viewISkinPatches().getSkinPatchSize(0) == 4
    assert driver.viewIOrientationSensors() is None


def test_unit_without_hardware() -> None:
    import yarp

    driver = yarp.PolyDriver("(device fakeIMU) (sensorName head) (constantValue 1)")
    gyroscopes = driver.viewIThreeAxisGyroscopes()
    assert gyroscopes.getNrOfThreeAxisGyroscopes() == 1
    assert gyroscopes.getThreeAxisGyroscopeName(0) == "head"
    assert driver.viewITemperatureSensors() is None
    assert driver.close()


def test_unit_behind_the_server() -> None:
    import yarp

    yarp.Network.setLocalMode(True)
    server, client = yarp.PolyDriver(), yarp.PolyDriver()
    try:
        assert server.open("(device multipleanalogsensorsserver) (name /imu) (period 10)")
        assert server.attach(Unit())
        options = "(device multipleanalogsensorsclient) (remote /imu) (local /me) (timeout 5.0)"
        assert client.open(options)
        gyroscopes, out = client.viewIThreeAxisGyroscopes(), yarp.DVector()
        assert gyroscopes.getNrOfThreeAxisGyroscopes() == 2
        assert gyroscopes.getThreeAxisGyroscopeMeasure(0, out) > 0.0
        assert [*out] == [0.0, 0.1, 0.2]
        assert gyroscopes.getThreeAxisGyroscopeFrameName(0) == "head"
        assert client.viewIThreeAxisMagnetometers().getNrOfThreeAxisMagnetometers() == 0
    finally:
        client.close()
        server.close()
        yarp.Network.setLocalMode(False)
