"""`yarpy dev`: a device that is served until it is asked to end."""

import re
import signal

import pytest
from click.testing import CliRunner

import yarpy
from yarpy.kits.launch.verbs.dev import command


def test_a_camera_is_served_until_it_is_asked_to_end(cli, names: yarpy.YarpNameClient) -> None:
    with cli.start("dev", "fakeFrameGrabber", "--name", "/dev/eye", "--width", "64") as process:
        process.wait_line(r"fakeFrameGrabber is served as /dev/eye \(frameGrabber_nws_yarp\)")
        with yarpy.devices.FrameGrabber("/dev/eye", names=names) as camera:
            assert camera.image(30).array.shape == (240, 64, 3)
        with yarpy.RpcClient("/dev/eye/quit", names=names) as client:
            assert client.call("sing") == ["huh?"]
            assert client.call("quit") == ["ok"]
        assert process.wait() == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it(cli, names: yarpy.YarpNameClient, number: signal.Signals) -> None:
    arguments = ("--device", "controlBoard_nws_yarp", "--subdevice", "fakeMotionControl")
    with cli.start("dev", *arguments, "--name", "/dev/arm", "--GENERAL::Joints", "6") as process:
        process.wait_line("fakeMotionControl is served as /dev/arm")
        with yarpy.RpcClient("/dev/arm/rpc:i", names=names) as client:
            assert client.call(["get", "axes"])[2] == 6
        process.signal(number)
        assert process.wait() == 0


def test_options_come_from_a_file_too(cli, names: yarpy.YarpNameClient) -> None:
    (cli.home / "arm.ini").write_text(
        "device controlBoard_nws_yarp\nsubdevice fakeMotionControl\nname /dev/file\n"
        "[GENERAL]\nJoints 2\nAxisName left right\n"
    )
    with cli.start("dev", "--from", "arm.ini", "--name", "/dev/said") as process:
        process.wait_line("is served as /dev/said")
        with yarpy.RpcClient("/dev/said/rpc:i", names=names) as client:
            assert client.call(["get", "axes"])[2] == 2
        process.signal(signal.SIGINT)
        assert process.wait() == 0


def test_it_waits_for_what_is_not_there_yet(cli, names: yarpy.YarpNameClient) -> None:
    arguments = ("--device", "remote_controlboard", "--remote", "/dev/late", "--wait", "300")
    with cli.start("dev", *arguments) as process:
        process.wait_line("remote_controlboard does not open:", stream="err")
        with cli.start("dev", "fakeMotionControl", "--name", "/dev/late") as late:
            late.wait_line("is served as /dev/late")
            process.wait_line("remote_controlboard is open")
            for one in (process, late):
                one.signal(signal.SIGINT)
                assert one.wait() == 0


def test_what_cannot_be_opened_is_said_in_one_line(cli) -> None:
    done = cli.run("dev", "--device", "fakeFrameGraber")
    assert done.returncode == 1
    assert done.stderr == (
        'error: no device of type "fakeFrameGraber" is installed: '
        'did you mean "fakeFrameGrabber"?\n'
    )
    done = cli.run("dev", "controlBoard_nws_yarp", "--subdevice", "nothing")
    assert (
        done.returncode == 1 and 'type "nothing" is installed: see yarpy dev --list' in done.stderr
    )
    done = cli.run("dev", "controlBoard_nws_yarp", "--name", "/dev/bare")
    assert done.returncode == 1 and "--subdevice TYPE" in done.stderr.splitlines()[-1]
    done = cli.run("dev", "remote_controlboard", "--remote", "/nobody/here")
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith("error: remote_controlboard does not open: ")
    assert "Traceback" not in done.stderr
    done = cli.run("dev", "a", "--device", "b")
    assert done.returncode == 1 and '"a" is no option' in done.stderr
    assert cli.run("dev", "--from", "none.ini").returncode == 1


@pytest.mark.parametrize("words", [[], ["--list"], ["fakeBattery", "--list"]])
def test_the_types_are_listed_with_their_purposes(words: list[str]) -> None:
    done = CliRunner().invoke(command, words, standalone_mode=False)
    assert done.return_value == 0
    assert re.search(r"^  fakeMotionControl +simulated joints of a robot: ", done.output, re.M)
