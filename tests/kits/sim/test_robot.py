"""The simulated robot on its ports, and its clients."""

from collections.abc import Iterator

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.devices import ControlBoard
from yarpy.kits.sim.robot import Parts, Robot, icub_head

PORTS = {
    *(f"/icubSim/head/{port}" for port in ("rpc:i", "command:i", "state:o", "stateExt:o")),
    *("/icubSim/cam/left", "/icubSim/cam/left/rpc", "/icubSim/cam/right", "/icubSim/cam/right/rpc"),
    *("/icubSim/inertial/measures:o", "/icubSim/inertial/rpc:o"),
}


@pytest.fixture(scope="module")
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        yield server


@pytest.fixture(scope="module")
def robot(server: yarpy.NameServer) -> Iterator[Robot]:
    with Robot("/icubSim", icub_head((64, 48))) as robot:
        yield robot


def test_ports(robot: Robot):
    for port in PORTS:
        assert yarpy.exists(port), port
    assert robot.ports == [
        *("/icubSim/head", "/icubSim/cam/left", "/icubSim/cam/right", "/icubSim/inertial")
    ]


def test_head(robot: Robot):
    with ControlBoard("/icubSim/head", "/client", timeout=HANG) as head:
        assert head.axis_names[1] == "neck_roll"
        head.position_move([1], [45.0])
        wait_until(lambda: all(head.motion_done()))
        wait_until(lambda: abs(head.encoders()[1] - 45.0) < 0.1, 20)
        head.position_move([1], [0.0])


def test_eyes(robot: Robot):
    with yarpy.BufferedPort("/eye") as port:
        for side in ("left", "right"):
            port.listen_to(f"/icubSim/cam/{side}")
            message = port.read(timeout=HANG)
            image = message.as_(yarpy.Image)
            assert (image.width, image.height, image.code) == (64, 48, "rgb")
            assert message.stamp.time > 1e9
            yarpy.disconnect(f"/icubSim/cam/{side}", "/eye")


def test_inertial_unit(robot: Robot):
    with yarpy.BufferedPort("/inertial") as port:
        port.listen_to("/icubSim/inertial/measures:o")
        measures = port.read(timeout=HANG).value
        assert len(measures) == 10
        gyroscopes, accelerometers, _, orientations = measures[:4]
        assert len(gyroscopes[0][0]) == len(orientations[0][0]) == 3
        assert sum(value**2 for value in accelerometers[0][0]) ** 0.5 == pytest.approx(9.8, abs=5)


def test_names(server: yarpy.NameServer):
    with Robot("other", Parts(cameras={"eye": icub_head((32, 32)).cameras["cam/left"]})) as other:
        assert other.ports == ["/other/eye"]
        assert yarpy.exists("/other/eye/rpc")
    assert yarpy.query("/other/eye") is None


def test_name_that_is_taken(robot: Robot):
    with pytest.raises(yarpy.AddressError, match="/icubSim/head"):
        Robot("/icubSim", icub_head((32, 32)))
    assert yarpy.exists("/icubSim/head/rpc:i")
