import logging
import threading

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle
from yarpy.data.yarp4 import is_yarp4 as is_yarp4_message
from yarpy.kits.devices.multi_sensor.server import MultiSensorServer


class Imu:
    """The sensors of the specification's recording."""

    frames = {"sensorName": "frameName"}

    def __init__(self):
        self.gyro = (10.0, 10.0, 10.0)

    def timestamps(self):
        return {"sensorName": 1795218186.44}

    def gyroscopes(self):
        return {"sensorName": self.gyro}

    def accelerometers(self):
        return {"sensorName": [1, 0, -9.5]}

    def thermometers(self):
        return {"inside": 40, "outside": 20.5}

    def skin_patches(self):
        return {"palm": range(5)}


@pytest.fixture
def server(names):
    with MultiSensorServer("/imu", Imu(), 0.005, names=names) as server:
        yield server


def test_measures(server, names):
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/imu/measures:o")
        message = port.read(HANG)
        found = message.as_(Bottle)
        assert message.stamp.time > 1e9 and message.stamp.valid
    assert len(found) == 10
    assert found[0] == [[[10.0, 10.0, 10.0], 1795218186.44]]
    assert found[1] == [[[1.0, 0.0, -9.5], 1795218186.44]]
    assert [values for values, _ in found[4]] == [[40.0], [20.5]]
    assert [values for values, _ in found[8]] == [[0.0, 1.0, 2.0, 3.0, 4.0]]
    assert [found[index] for index in (2, 3, 5, 6, 7, 9)] == [[]] * 6


def test_bytes_are_those_of_cpp(server, names):
    """Spec: headers of the outer list, of a kind, of a sensor, of its values; then the time."""
    with yarpy.BufferedPort("/me", names=names) as port:
        port.listen_to("/imu/measures:o")
        data = bytes(port.read(HANG).payload)
    assert data[:40].hex(" ") == (
        "00 01 00 00 0a 00 00 00 00 01 00 00 01 00 00 00 00 01 00 00 02 00 00 00 "
        "0a 01 00 00 03 00 00 00 00 00 00 00 00 00 24 40"
    )
    assert data[56:60].hex(" ") == "0a 00 00 00"
    assert data.endswith(bytes.fromhex("0001000000000000"))  # a kind without sensors


def test_names(server, names):
    with yarpy.RpcClient("/imu/rpc:o", names=names) as client:
        reply = client.call(["getMetadata"], timeout=HANG)
        assert len(reply) == 10
        assert reply[0] == reply[1] == [["sensorName", "frameName", ""]]
        assert reply[4] == [["inside", "inside", ""], ["outside", "outside", ""]]
        assert reply[8] == [["palm", "", ""]]
        assert client.call("getMetadata", timeout=HANG) == reply
        said = ["many", ["*** Available commands:", "getMetadata", "help"]]
        assert client.call("help", timeout=HANG) == said
        for question in ("x", "getMetadata x", "", "get Metadata"):
            assert client.call(Bottle.from_text(question), timeout=HANG)[0] == "fail"


def test_twelve_kinds_for_newer_programs(names):
    with (
        MultiSensorServer("/new", Imu(), 0.005, newer=True, names=names),
        yarpy.RpcClient("/new/rpc:o", names=names) as client,
        yarpy.BufferedPort("/me", names=names) as port,
    ):
        assert len(client.call(["getMetadata"], timeout=HANG)) == 12
        port.listen_to("/new/measures:o")
        assert len(port.read(HANG).value) == 12


def test_a_sensor_that_fails_keeps_its_last_values(names, caplog):
    imu = Imu()
    times = iter(range(1, 1000000))
    imu.timestamps = lambda: {"sensorName": float(next(times))}
    with (
        caplog.at_level(logging.WARNING),
        MultiSensorServer("/imu", imu, 0.005, names=names),
        yarpy.BufferedPort("/me", names=names) as port,
    ):
        port.listen_to("/imu/measures:o")
        port.read(HANG)
        imu.gyro = (1.0, 2.0)  # one is missing
        wait_until(lambda: "gyroscopes" in caplog.text)

        def kept() -> bool:
            """The first one may be from before; the others go on."""
            before, after = (port.read(HANG).as_(Bottle) for _ in range(2))
            assert before[0][0][0] == after[0][0][0] == [10.0, 10.0, 10.0]
            return before[0] == after[0] and before[1][0][1] < after[1][0][1]

        wait_until(kept)
        imu.gyro = (3.0, 2.0, 1.0)
        wait_until(lambda: port.read(HANG).as_(Bottle)[0][0][0] == [3.0, 2.0, 1.0])


class Dated:
    """A sensor that counts how often it was read, and calls that the time."""

    def __init__(self):
        self.reads = 0

    def gyroscopes(self):
        self.reads += 1
        return {"gyro": (float(self.reads), 0.0, 0.0)}

    def timestamps(self):
        return {"gyro": float(self.reads)}


def test_time_is_that_of_the_values_it_comes_with(names):
    """Not of those before, which after a pause are minutes old."""
    with (
        MultiSensorServer("/imu", Dated(), 0.005, names=names),
        yarpy.BufferedPort("/me", names=names) as port,
    ):
        for _ in range(2):
            port.listen_to("/imu/measures:o")
            [[[[value, _, _], at]], *_] = port.read(HANG).as_(Bottle)
            assert at == value
            yarpy.disconnect("/imu/measures:o", "/me", names=names)


def test_nothing_is_read_while_nobody_listens(names):
    asked = []

    class Watched:
        def gyroscopes(self):
            asked.append(1)
            return {"gyro": (0.0, 0.0, 0.0)}

    with MultiSensorServer("/imu", Watched(), 0.001, names=names):
        assert len(asked) == 1  # for the names
        threading.Event().wait(0.05)
        assert len(asked) == 1


class Failing:
    def gyroscopes(self):
        raise OSError("cable")


class Short:
    def gyroscopes(self):
        return {"gyro": (0.0, 0.0)}


class Listing:
    def gyroscopes(self):
        return [(0.0, 0.0, 0.0)]


class Empty:
    def skin_patches(self):
        return {"palm": ()}


class Nothing:
    def gyroscopes(self):
        return {}


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        (Failing, "cable"),
        (Short, "gyro has 2 values, not 3"),
        (Listing, "must return a dict"),
        (Empty, "palm has 0 values"),
        (Nothing, "needs one of gyroscopes"),
        (object, "needs one of gyroscopes"),
    ],
)
def test_bad_devices_open_nothing(names, kind, reason):
    with pytest.raises(ValueError, match=reason):
        MultiSensorServer("/imu", kind(), names=names)
    assert names.query("/imu/rpc:o") is None


def test_closing_leaves_nothing(names):
    before = {thread.name for thread in threading.enumerate()}
    server = MultiSensorServer("imu", Imu(), names=names)
    assert repr(server) == (
        "<MultiSensorServer /imu, 1 gyroscopes, 1 accelerometers, 2 thermometers, 1 skin_patches>"
    )
    assert "yarpy device /imu" in {thread.name for thread in threading.enumerate()}
    server.close()
    server.close()
    wait_until(lambda: {thread.name for thread in threading.enumerate()} <= before)
    assert names.query("/imu/measures:o") is None


def test_programs_of_yarp_4_get_all_kinds(server, names, monkeypatch):
    asked = []

    def is_yarp4(port, target):
        asked.append(target)
        return target == "/newer/measures:i"

    monkeypatch.setattr("yarpy.port.port.MessagePort._is_yarp4", is_yarp4)
    with (
        yarpy.BufferedPort("/newer/measures:i", names=names) as newer,
        yarpy.BufferedPort("/older/measures:i", names=names) as older,
        yarpy.RpcClient("/imu/rpc:o", name="/newer/rpc:i", names=names) as asks,
        yarpy.RpcClient("/imu/rpc:o", name="/older/rpc:i", names=names) as asks_too,
    ):
        newer.listen_to("/imu/measures:o")
        older.listen_to("/imu/measures:o")
        data = bytes(newer.read(HANG).to_bytes())
        assert data[:8] == bytes.fromhex("00010000 0c000000") and is_yarp4_message(data)
        assert len(older.read(HANG).as_(Bottle)) == 10
        assert len(asks.call(["getMetadata"], timeout=HANG)) == 12
        assert len(asks_too.call(["getMetadata"], timeout=HANG)) == 10
