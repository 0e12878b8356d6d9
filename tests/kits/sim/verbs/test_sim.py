"""`yarpy sim`."""

import signal
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from support.ros2_peer import ros2_router
from support.ros_graph import ros_graph
from support.wait import HANG, wait_until

import yarpy
from yarpy.clock import spelled

ARM = Path(__file__).parents[3] / "support" / "arm.xml"


def test_robot_of_a_name(cli, names):
    words = ("--robot", "robbie", "--size", "64x48", "--fps", "50")
    with (
        cli.start("sim", *words) as process,
        yarpy.BufferedPort("/sim/eye", strict=True, names=names) as eye,
    ):
        ready = process.wait_line(r"^/robbie is ready: (.*)$", stream="out", timeout=HANG)[1]
        assert ready == "/robbie/head /robbie/cam/left /robbie/cam/right /robbie/inertial"
        with yarpy.RpcClient("/robbie/head/rpc:i", names=names) as head:
            assert head.call("set", "pos", 1, 20) == ["ok"]
            wait_until(lambda: abs(head.call("get", "enc", 1)[2] - 20) < 0.01)
        eye.listen_to("/robbie/cam/left")
        image = eye.read(timeout=HANG).as_(yarpy.Image)
        assert (image.width, image.height) == (64, 48)
        process.signal(signal.SIGINT)
        assert process.wait() == 0, process.stderr
        assert "Traceback" not in process.stderr
    assert names.list("/robbie") == []


def test_a_whole_icub(cli, names):
    with cli.start("sim", "--whole") as process:
        ready = process.wait_line(r"^/icubSim is ready: (.*)$", stream="out", timeout=HANG)[1]
        assert "/icubSim/left_arm /icubSim/right_arm /icubSim/left_leg" in ready
        with yarpy.RpcClient("/icubSim/right_arm/rpc:i", names=names) as arm:
            assert arm.call("get", "axes")[2] == 16
            assert arm.call("get", "enc", 3)[2] == 15  # an elbow cannot be straight
        process.signal(signal.SIGINT)
        assert process.wait() == 0, process.stderr


def test_time_of_the_network(cli, names, monkeypatch):
    """What moves, what is answered and what is sent has the time of the clock."""
    monkeypatch.setitem(cli.environment, "YARP_CLOCK", "/clock")
    ports = ("head/state:o", "cam/left", "inertial/measures:o")
    with (
        yarpy.Port("/clock", names=names) as clock,
        cli.start("sim", "--size", "64x48") as process,
    ):
        ticks = iter(range(1, 100_000))

        def tick() -> bool:
            return clock.write(yarpy.Bottle(spelled(next(ticks) / 1000)))

        wait_until(lambda: tick() and process.stdout)
        process.wait_line("^/icubSim is ready", stream="out", timeout=HANG)
        with yarpy.RpcClient("/icubSim/head/rpc:i", names=names) as head:
            assert head.call("set", "pos", 1, 20) == ["ok"]
            assert head.call("get", "enc", 1)[2] < 20  # it does not move while the clock stands
            clock.write(yarpy.Bottle([100, 0]))
            wait_until(lambda: abs(head.call("get", "enc", 1)[2] - 20) < 0.01)
            assert head.call("get", "enc", 1)[5] == 100
        for source in ports:
            heard: list[yarpy.Message] = []
            with yarpy.BufferedPort("/sim/listener", callback=heard.append, names=names) as ear:
                ear.listen_to(f"/icubSim/{source}")
                wait_until(lambda heard=heard: tick() and heard)
                assert 0 < heard[0].stamp.time <= 100
        process.signal(signal.SIGINT)
        assert process.wait() == 0, process.stderr


def test_a_model_says_what_it_has(cli):
    result = cli.run("sim", "--whole", "--mujoco", str(ARM))
    assert result.returncode == 1 and "--whole is the iCub's" in result.stderr


@pytest.mark.peer("ros", "rosmaster")
def test_a_node_of_ros(tmp_path):
    with ros_graph(tmp_path) as graph:
        assert graph.yarpy("namespace", "/ros").wait() == 0
        assert graph.yarpy("detect", "--ros").wait() == 0
        with graph.yarpy("sim", "--ros", "--size", "64x48", ROS_MASTER_URI="") as process:
            process.wait_line(r"^/icubSim is ready", stream="out", timeout=HANG)
            topics = graph.tool("rostopic", "list").split()
            for topic in ("/icubSim/joint_states", "/icubSim/cam/left", "/icubSim/cam/right"):
                assert topic in topics
            assert "neck_yaw" in graph.tool("rostopic", "echo", "-n", "1", "/icubSim/joint_states")
            process.signal(signal.SIGINT)
            assert process.wait(HANG) == 0, process.stderr
        assert "/icubSim" not in graph.tool("rosnode", "list").split()


def test_a_node_of_ros_2(cli, monkeypatch):
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[ros2]"')
    from yarpy.peers import ros2

    for variable in ("RMW_IMPLEMENTATION", "ROS_DOMAIN_ID", "ZENOH_SESSION_CONFIG_URI"):
        monkeypatch.delenv(variable, raising=False)
    with ros2_router() as number:
        monkeypatch.setenv("YARPY_ZENOH", f"127.0.0.1:{number}")
        cli.environment["YARPY_ZENOH"] = f"127.0.0.1:{number}"
        states = []
        with cli.start("sim", "--ros2", "--size", "64x48") as process, ros2.Node("/me") as node:
            process.wait_line(r"^/icubSim is ready", stream="out", timeout=HANG)
            node.subscriber("/icubSim/joint_states", "sensor_msgs/msg/JointState", states.append)
            wait_until(lambda: states, HANG)
            assert "neck_yaw" in states[0].name
            process.signal(signal.SIGINT)
            assert process.wait(HANG) == 0, process.stderr


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (("--size", "big"), "'big' is no size; say 640x480"),
        (("--size", "5x5"), "from 16 to 2048 pixels"),
        (("--fps", "0"), "is not from 0.1 to 1000"),
        (("--mujoco", "/no/such/model.xml"), "does not exist"),
    ],
)
def test_wrong_options(here, words, reason):
    said = here("sim", *words)
    assert said.code == 1
    assert reason in said.err


def test_name_that_is_taken(here, names):
    with yarpy.Port("/taken/head/rpc:i", names=names):
        said = here("sim", "--robot", "/taken")
    assert said.code == 1
    assert "is in use" in said.err
    assert names.list("/taken") == []


def needs_mujoco():
    """Not by importing it: how it draws is decided when it is imported, and not here."""
    if find_spec("mujoco") is None:
        pytest.skip("no MuJoCo: pip install 'yarpy[sim]'")


def test_mujoco_model(cli, names):
    needs_mujoco()
    with (
        cli.start("sim", "--mujoco", str(ARM), "--size", "64x48") as process,
        yarpy.BufferedPort("/sim/watching", strict=True, names=names) as watching,
    ):
        ready = process.wait_line(r"^/little_arm is ready: (.*)$", stream="out", timeout=HANG)
        assert {"/little_arm/joints", "/little_arm/inertial"} <= {*ready[1].split()}
        with yarpy.RpcClient("/little_arm/joints/rpc:i", names=names) as joints:
            assert joints.call("get", "name", 0)[2] == "shoulder"
            assert joints.call("set", "pos", 0, 30) == ["ok"]
            wait_until(lambda: abs(joints.call("get", "enc", 0)[2] - 30) < 0.5)
        if "no cameras" not in process.stderr:
            watching.listen_to("/little_arm/cam/watching")
            assert watching.read(timeout=HANG).as_(yarpy.Image).width == 64
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 0, process.stderr
        assert "Traceback" not in process.stderr


def test_file_that_is_no_model(here, tmp_path):
    needs_mujoco()
    file = tmp_path / "model.xml"
    file.write_text("<mujoco><worldbody><nonsense/></worldbody></mujoco>")
    said = here("sim", "--mujoco", str(file))
    assert said.code == 1
    assert "nonsense" in said.err
    assert len(said.err.splitlines()) == 1


def test_without_mujoco(here, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    file = tmp_path / "model.xml"
    file.write_text("<mujoco/>")
    said = here("sim", "--mujoco", str(file))
    assert said.code == 1
    assert "pip install 'yarpy[sim]'" in said.err
