"""Sensors between yarpy and C++: our server behind the client of C++, our client before its server.

MultiSensor (yarpy) -> multipleanalogsensorsserver -> ...client -> MultiSensorServer
"""

import pytest
from support.cpp import CppYarp
from support.cpp_device import cpp_device, device_host
from support.wait import HANG, wait_until

from yarpy.kits.devices import MultiSensor, MultiSensorServer


class Sensors:
    """One of nearly everything."""

    frames = {"left": "l_imu"}

    def __init__(self):
        self.gyro = (1.0, 2.0, 3.0)

    def timestamps(self):
        return {"left": 5.0}

    def gyroscopes(self):
        return {"left": self.gyro, "right": (4.0, 5.0, 6.0)}

    def accelerometers(self):
        return {"left": (0.0, 0.0, 9.8)}

    def magnetometers(self):
        return {"left": (1.0, 2.0, 3.0)}

    def orientations(self):
        return {"left": (0.0, 90.0, 0.0)}

    def thermometers(self):
        return {"inside": 40.5}

    def force_torques(self):
        return {"arm": (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)}

    def encoder_arrays(self):
        return {"hand": (1.0, 2.0)}

    def skin_patches(self):
        return {"palm": (1.0, 2.0, 3.0, 4.0)}


@pytest.mark.peer("g++")
def test_chain(network: CppYarp) -> None:
    device_host(network)
    sensors = Sensors()
    with (
        MultiSensorServer("/ours", sensors, 0.005),
        cpp_device(
            network,
            "multipleanalogsensorsserver",
            subdevice="multipleanalogsensorsclient",
            remote="/ours",
            local="/between",
            name="/cpp",
            period=10,
            timeout=HANG,
        ) as process,
    ):
        assert "not available" not in process.stdout
        with MultiSensor("/cpp", timeout=HANG) as client:
            wait_until(lambda: client.gyroscopes()["left"] == (1.0, 2.0, 3.0))
            assert client.gyroscopes()["right"] == (4.0, 5.0, 6.0)
            assert client.accelerometers() == {"left": (0.0, 0.0, 9.8)}
            assert client.magnetometers() == {"left": (1.0, 2.0, 3.0)}
            assert client.orientations() == {"left": (0.0, 90.0, 0.0)}
            assert client.thermometers() == {"inside": (40.5,)}
            assert client.force_torques() == {"arm": (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)}
            assert client.encoder_arrays() == {"hand": (1.0, 2.0)}
            assert client.skin_patches() == {"palm": (1.0, 2.0, 3.0, 4.0)}
            assert client.timestamps()["left"] == 5.0
            assert client.frames["left"] == "l_imu"
            sensors.gyro = (7.0, 8.0, 9.0)
            wait_until(lambda: client.gyroscopes()["left"] == (7.0, 8.0, 9.0))
