"""PolyDriver: the script for an iCub's head against our robot, C++ YARP's control board, our own
server of a Python device; cameras; what cannot be opened."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from support.cpp import CppYarp
from support.cpp_device import cpp_device, device_host
from support.environment import configured_for
from support.port import free_block
from support.process import Process
from support.wait import HANG

import yarpy
from yarpy.kits.devices import Gains
from yarpy.kits.sim.robot import Robot, icub_head

SCRIPT = Path(__file__).parent / "programs" / "icub_head.py"


@pytest.fixture
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(free_block(200)) as found:
        yield found


def run(remote: str, environment: Mapping[str, str], server: yarpy.NameServer) -> None:
    variables = {**environment, **server.environment}
    with Process([sys.executable, SCRIPT, remote], env=variables) as process:
        code = process.wait(2 * HANG)
    assert code == 0, process.stdout + process.stderr
    lines = process.stdout.splitlines()
    assert lines[1:] == [
        f"encoders True {lines[0].split()[1]} {lines[0].split()[1]}",
        "limits True True",
        "mode True",
        "speed True True",
        "move True",
        "there True",
        "modes True",
        "move two True",
        "all True pos",
        "stop True True",
        "wrong False",
        "pid True",
        "closed False",
    ]
    assert lines[0].endswith("True")


def test_script_moves_the_simulated_head(
    environment: Mapping[str, str], server: yarpy.NameServer
) -> None:
    with Robot("/icubSim", icub_head((160, 120))):
        run("/icubSim/head", environment, server)


@pytest.mark.peer("cpp", "g++")
def test_script_moves_the_head_through_cpp(
    environment: Mapping[str, str], tmp_path: Path, server: yarpy.NameServer
) -> None:
    """Through controlBoard_nws_yarp of C++ YARP."""
    cpp = CppYarp.prepare(tmp_path)
    device_host(cpp)
    with (
        cpp.at("127.0.0.1", server.port) as programs,
        configured_for(programs, by_file=False),
        Robot("/icubSim", icub_head((160, 120))),
        cpp_device(
            programs,
            "controlBoard_nws_yarp",
            subdevice="remote_controlboard",
            remote="/icubSim/head",
            local="/between",
            name="/cpp/head",
            period=0.01,
        ),
    ):
        run("/cpp/head", environment, server)


class Arm:
    """A device in Python: it is where it was told to be."""

    axis_names = ["shoulder", "elbow"]
    reference_speeds = [10.0, 10.0]
    reference_accelerations = [1.0, 1.0]
    position_limits = [(-90.0, 90.0), (0.0, 120.0)]
    temperature_limits = [60.0, 60.0]

    class Pids:
        gains = [Gains(1.0, 2.0, 3.0), Gains(4.0)]
        enabled = [True, False]
        targets = [0.0, 0.0]

        def __init__(self) -> None:
            self.was_reset: list[int] = []

        def errors(self) -> list[float]:
            return [0.5, -0.5]

        def reset(self, joints: list[int]) -> None:
            self.was_reset += joints

    def __init__(self) -> None:
        self.at = [1.0, 2.0]
        self.modes = ["pos", "pos"]
        self.pids = {"pos": self.Pids()}
        self.variables = {"colour": "red"}

    def encoders(self) -> list[float]:
        return self.at

    def control_modes(self) -> list[str]:
        return self.modes

    def interaction_modes(self) -> list[str]:
        return ["stif", "comp"]

    def torques(self) -> list[float]:
        return [0.1, 0.2]

    def faults(self) -> list[tuple[int, str]]:
        return [(0, ""), (7, "too hot")]

    def motion_done(self) -> list[bool]:
        return [True, False]

    def position_move(self, joints: list[int], positions: list[float]) -> None:
        for joint, position in zip(joints, positions, strict=True):
            self.at[joint] = position

    def velocity_move(self, joints: list[int], speeds: list[float]) -> None:
        self.speeds = [*zip(joints, speeds, strict=True)]

    def switch_control_modes(self, joints: list[int], modes: list[str]) -> None:
        for joint, mode in zip(joints, modes, strict=True):
            self.modes[joint] = mode

    def stop(self, joints: list[int]) -> None:
        self.stopped = joints


def test_views_of_a_python_device() -> None:
    import yarp

    arm, driver = Arm(), yarp.PolyDriver()
    driver.give(arm, True)
    pos, encoders = driver.viewIPositionControl(), driver.viewIEncoders()
    vector, pair = yarp.DVector(2), yarp.DVector(2)
    assert pos.getAxes() == 2
    assert pos.positionMove(yarp.DVector([5.0, 6.0])) and arm.at == [5.0, 6.0]
    assert pos.positionMove(1, 7) and arm.at == [5.0, 7]
    assert pos.positionMove(1, yarp.IVector([0]), yarp.DVector([8.0])) and arm.at[0] == 8.0
    assert encoders.getEncoders(vector) and [*vector] == [8.0, 7.0]
    assert encoders.getEncoder(1) == 7.0
    assert not encoders.getEncoderSpeeds(vector)
    assert pos.checkMotionDone(0) and not pos.checkMotionDone(1) and not pos.checkMotionDone()
    flags = yarp.BVector(2)
    assert pos.checkMotionDone(flags) and [*flags] == [True, False]
    assert pos.setRefSpeed(1, 30.0) and arm.reference_speeds == [10.0, 30.0]
    assert pos.getRefSpeeds(vector) and [*vector] == [10.0, 30.0]
    assert pos.getRefSpeed(1, pair) and pair[0] == 30.0
    assert pos.stop(1) and arm.stopped == [1]
    velocity = driver.viewIVelocityControl()
    assert velocity.velocityMove(0, 3.0) and arm.speeds == [(0, 3.0)]
    modes = driver.viewIControlMode()
    assert modes.setControlMode(0, yarp.VOCAB_CM_VELOCITY) and arm.modes == ["vel", "pos"]
    assert modes.getControlMode(0) == yarp.VOCAB_CM_VELOCITY
    codes = yarp.IVector(2)
    assert modes.getControlModes(codes) and yarp.decode(codes[1]) == "pos"
    assert driver.viewIInteractionMode().getInteractionMode(1) == yarp.VOCAB_IM_COMPLIANT
    lowest, highest = yarp.DVector(1), yarp.DVector(1)
    limits = driver.viewIControlLimits()
    assert limits.getLimits(1, lowest, highest) and (lowest[0], highest[0]) == (0.0, 120.0)
    assert limits.setLimits(1, -5.0, 5.0) and arm.position_limits[1] == (-5.0, 5.0)
    assert driver.viewITorqueControl().getTorque(1, lowest) and lowest[0] == 0.2
    assert driver.viewIAxisInfo().getAxisName(1) == "elbow"
    assert driver.viewIAxisInfo().getAxisName(9) == ""
    code, words = yarp.IVector(1), yarp.SVector(1)
    faults = driver.viewIJointFault()
    assert faults.getLastJointFault(1, code, words) and (code[0], words[0]) == (7, "too hot")
    assert not faults.getLastJointFault(2, code, words)
    assert driver.viewIPositionDirect() is None
    assert driver.viewIFrameGrabberImage() is None
    words = yarp.Bottle()
    variables = driver.viewIRemoteVariables()
    assert variables.getRemoteVariablesList(words) and words.toString() == "colour"
    assert variables.getRemoteVariable("colour", words) and words.toString() == "red"
    assert variables.setRemoteVariable("colour", yarp.Bottle("blue 1"))
    assert arm.variables["colour"] == ["blue", 1]


def test_pids() -> None:
    import yarp

    arm, driver = Arm(), yarp.PolyDriver()
    driver.give(arm, True)
    pids, kind = driver.viewIPidControl(), yarp.VOCAB_PIDTYPE_POSITION
    found = yarp.PidVector(1)
    assert pids.getPid(kind, 0, found) and (found[0].kp, found[0].kd, found[0].ki) == (1, 2, 3)
    every = yarp.PidVector(2)
    assert pids.getPids(kind, every) and every[1].kp == 4.0
    assert pids.setPid(kind, 1, yarp.Pid(9.0, 8.0))
    assert arm.pids["pos"].gains[1][:2] == (9.0, 8.0)
    flag, errors = yarp.BVector(1), yarp.DVector(2)
    assert pids.isPidEnabled(kind, 0, flag) and flag[0]
    assert pids.disablePid(kind, 0) and arm.pids["pos"].enabled == [False, False]
    assert pids.getPidErrors(kind, errors) and [*errors] == [0.5, -0.5]
    assert pids.setPidReference(kind, 1, 3.0) and arm.pids["pos"].targets == [0.0, 3.0]
    assert pids.resetPid(kind, 1) and arm.pids["pos"].was_reset == [1]
    assert not pids.getPid(yarp.VOCAB_PIDTYPE_TORQUE, 0, found)


def test_python_device_behind_the_wrapper() -> None:
    import yarp

    yarp.Network.setLocalMode(True)
    arm, wrapper, client = Arm(), yarp.PolyDriver(), yarp.PolyDriver()
    try:
        assert wrapper.open(yarp.Property("(device controlBoard_nws_yarp) (name /arm)"))
        assert wrapper.isValid() and wrapper.attach(arm)
        assert not wrapper.attach(arm)
        options = "(device remote_controlboard) (remote /arm) (local /client)"
        assert client.open(yarp.Property(options))
        encoders = yarp.DVector(2)
        while not client.viewIEncoders().getEncoders(encoders):
            yarp.delay(0.02)
        assert [*encoders] == [1.0, 2.0]
        assert client.viewIPositionControl().positionMove(0, 12.0)
        assert arm.at[0] == 12.0
    finally:
        client.close()
        wrapper.close()
        yarp.Network.setLocalMode(False)
    assert not client.isValid() and not wrapper.isValid()


def test_motors_without_hardware() -> None:
    import yarp

    driver = yarp.PolyDriver("fakeMotionControl")
    pos, encoders = driver.viewIPositionControl(), driver.viewIEncoders()
    assert pos.getAxes() == 4
    assert pos.positionMove(1, 500.0) and encoders.getEncoder(1) == 180.0
    assert pos.checkMotionDone()
    with pytest.raises(TypeError, match="a joint is a number, not 'elbow'"):
        pos.positionMove("elbow", 5.0)
    modes = driver.viewIControlMode()
    assert modes.setControlMode(0, yarp.VOCAB_CM_FORCE_IDLE)
    assert modes.getControlMode(0) == yarp.VOCAB_CM_IDLE
    assert driver.viewIPositionDirect().setPosition(2, 3.0) and encoders.getEncoder(2) == 3.0
    assert driver.viewIInteractionMode().setInteractionMode(0, yarp.VOCAB_IM_COMPLIANT)
    assert driver.viewIInteractionMode().getInteractionMode(0) == yarp.VOCAB_IM_COMPLIANT
    image = yarp.ImageRgb()
    assert yarp.PolyDriver("(device fakeFrameGrabber)").viewIFrameGrabberImage().getImage(image)
    assert (image.width(), image.height()) == (320, 240)


def test_what_cannot_be_opened(capfd: pytest.CaptureFixture[str]) -> None:
    import yarp

    yarp.Network.setLocalMode(True)
    try:
        assert not yarp.PolyDriver("(device nonsense)").isValid()
        said = capfd.readouterr().err
        assert "yarpy-compat has " in said and " LLM_nwc_yarp, " in said
        assert not yarp.PolyDriver("(device remote_controlboard) (remote /none)").isValid()
        assert '"/none' in capfd.readouterr().err
        assert not yarp.PolyDriver("(device remote_controlboard) (local /me)").isValid()
        assert 'the option "remote"' in capfd.readouterr().err
        with pytest.raises(TypeError, match="opened by its options, a Property, not 3"):
            yarp.PolyDriver(3)
        assert not yarp.PolyDriver("(device controlBoard_nws_yarp)").isValid()
        assert yarp.PolyDriver().viewIEncoders() is None
        with pytest.raises(AttributeError, match=r"no device of yarpy-compat has .*viewIVisual"):
            _ = yarp.PolyDriver().viewIVisualServoing
    finally:
        yarp.Network.setLocalMode(False)


def test_camera() -> None:
    import yarp

    yarp.Network.setLocalMode(True)
    driver = yarp.PolyDriver()
    try:
        from yarp import _names

        with Robot("/icubSim", icub_head((160, 120)), names=_names.names()):
            options = "(device frameGrabber_nwc_yarp) (remote /icubSim/cam/left) (local /eye)"
            assert driver.open(yarp.Property(options))
            camera, image = driver.viewIFrameGrabberImage(), yarp.ImageRgb()
            assert (camera.width(), camera.height()) == (160, 120)
            assert camera.getImage(image)
            assert (image.width(), image.height()) == (160, 120)
            controls = driver.viewIFrameGrabberControls()
            assert controls.hasFeature(yarp.YARP_FEATURE_GAIN) in (True, False)
            assert not controls.hasFeature(99)
            assert isinstance(controls.getGain(), float | int)
            driver.close()
    finally:
        driver.close()
        yarp.Network.setLocalMode(False)
