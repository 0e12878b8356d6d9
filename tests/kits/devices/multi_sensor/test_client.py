import pytest
from support.wait import HANG, wait_until
from support.yarp4 import recorded

import yarpy
from yarpy import Bottle
from yarpy.errors import DecodeError, RemoteProtocolError, Timeout, UnknownName
from yarpy.kits.devices.multi_sensor.client import MultiSensor
from yarpy.kits.devices.multi_sensor.interface import KINDS, MultiSensorLike
from yarpy.kits.devices.multi_sensor.server import MultiSensorServer
from yarpy.wire.message import Encoded


class Imu:
    frames = {"left": "l_imu"}

    def __init__(self):
        self.gyro = (1.0, 2.0, 3.0)

    def timestamps(self):
        return {"left": 5.0, "right": 6.0}

    def gyroscopes(self):
        return {"left": self.gyro, "right": (4.0, 5.0, 6.0)}

    def orientations(self):
        return {"left": (0.0, 90.0, 0.0)}


@pytest.fixture
def imu():
    return Imu()


@pytest.fixture
def near(imu, names):
    with (
        MultiSensorServer("/imu", imu, 0.005, names=names),
        MultiSensor("/imu", timeout=HANG, names=names) as client,
    ):
        yield client


@pytest.fixture
def relayed(near, names):
    with (
        MultiSensorServer("/relay", near, 0.005, names=names),
        MultiSensor("/relay", timeout=HANG, names=names) as client,
    ):
        yield client


@pytest.fixture(params=["near", "relayed"])
def client(request):
    return request.getfixturevalue(request.param)


def test_it_is_a_whole_set_of_sensors():
    members = {*vars(MultiSensorLike)} | {"timestamps"}
    assert {n for n in members if not n.startswith("_")} - {*dir(MultiSensor)} == set()
    assert set(KINDS) <= set(dir(MultiSensor))


def test_values_by_name(client, imu):
    assert client.gyroscopes() == {"left": (1.0, 2.0, 3.0), "right": (4.0, 5.0, 6.0)}
    assert client.orientations() == {"left": (0.0, 90.0, 0.0)}
    assert client.timestamps() == {"left": 5.0, "right": 6.0}
    assert client.frames["left"] == "l_imu"
    assert client.frames["right"] == "right"
    for kind in KINDS:
        if kind not in ("gyroscopes", "orientations"):
            assert getattr(client, kind)() == {}
    imu.gyro = (7.0, 8.0, 9.0)
    wait_until(lambda: client.gyroscopes()["left"] == (7.0, 8.0, 9.0))
    assert "2 gyroscopes, 1 orientations" in repr(client)


def test_twelve_kinds_of_newer_programs(names):
    imu = Imu()
    imu.linear_velocities = lambda: {"legs": (0.1, 0.2, 0.3)}
    with (
        MultiSensorServer("/imu", imu, 0.005, names=names),
        MultiSensor("/imu", timeout=HANG, names=names) as client,
        MultiSensorServer("/relay", client, 0.005, names=names),
        MultiSensor("/relay", timeout=HANG, names=names) as relayed,
    ):
        assert client.linear_velocities() == {"legs": (0.1, 0.2, 0.3)}
        assert relayed.linear_velocities() == client.linear_velocities()
        assert relayed.angular_accelerations() == {}
        assert relayed.gyroscopes()["right"] == (4.0, 5.0, 6.0)
        assert repr(client).endswith("1 orientations, 1 linear_velocities>")


def test_what_cpp_4_sends(names):
    recording = recorded("sensors")

    def answer(message):
        assert message.value == ["getMetadata"] or message.value == "getMetadata"
        return Encoded(bytes.fromhex(recording["metadata"]))

    with (
        yarpy.RpcServer("/imu/rpc:o", answer, names=names),
        yarpy.BufferedPort("/imu/measures:o", names=names) as source,
        MultiSensor("/imu", timeout=HANG, names=names) as client,
    ):
        source.write(Encoded(bytes.fromhex(recording["measures"])))
        assert client.gyroscopes() == {"sensorName": (172.0, 172.0, 172.0)}
        assert client.accelerometers()["sensorName"][1:] == (0.0, 9.71244071567254)
        assert client.frames == {"sensorName": "frameName"}
        assert client.angular_accelerations() == {}


def test_silence(names):
    reply = Bottle.from_text('((a b "")) () () () () () () () () ()')
    with (
        yarpy.RpcServer("/imu/rpc:o", lambda message: reply, names=names),
        yarpy.Port("/imu/measures:o", names=names) as output,
        MultiSensor("/imu", timeout=HANG, names=names) as client,
    ):
        with (
            MultiSensor("/imu", timeout=0.1, names=names) as hasty,
            pytest.raises(Timeout, match="nothing came"),
        ):
            hasty.gyroscopes()
        assert client.magnetometers() == {}
        for text in ("1 2", "() " * 10, "((5 1.0)) " + "() " * 9, "(((x y z) 1.0)) " + "() " * 9):
            output.write(Bottle.from_text(text), wait=True)
            with pytest.raises(DecodeError):
                client.gyroscopes()
        output.write(Bottle.from_text("(((1 2 3) 1.0)) " + "() " * 9), wait=True)
        assert client.gyroscopes() == {"a": (1.0, 2.0, 3.0)}


@pytest.mark.parametrize("text", ["[fail]", "", "5", "1 2 3", "((a)) " + "() " * 9, "5 " * 10])
def test_no_sensors(names, text):
    with (
        yarpy.RpcServer("/imu/rpc:o", lambda message: Bottle.from_text(text), names=names),
        yarpy.Port("/imu/measures:o", names=names),
    ):
        with pytest.raises(RemoteProtocolError, match="names no sensors"):
            MultiSensor("/imu", "/me", names=names)
        assert names.query("/me/rpc:i") is None


def test_nobody_there(names):
    with pytest.raises(UnknownName):
        MultiSensor("/imu", names=names)
