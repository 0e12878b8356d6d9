"""The words of C++ YARP at the port of a robot."""

import threading

import yarpy
from yarpy import Bottle
from yarpy.kits.launch.robot.robot import Robot
from yarpy.kits.launch.robot.robot_file import load
from yarpy.kits.launch.robot.rpc import Answers, port_name

from .conftest import Write


def test_words_as_people_and_programs_say_them(write: Write, network: yarpy.LocalNames) -> None:
    path = write('<device name="a" type="t"/>')

    def plugin(options: yarpy.Property, *, names: object = None) -> object:
        return object()

    robot, over = Robot(load(path), lambda kind: plugin), threading.Event()
    name = port_name("r")
    with (
        yarpy.RpcServer(name, Answers(robot, over.set), names=network),
        yarpy.RpcClient(name, names=network) as client,
    ):

        def said(text: str) -> str:
            answer = client.call(Bottle.from_text(text))
            return Bottle(answer if isinstance(answer, list) else [answer]).to_text()

        assert said("get_phase") == said("get phase") == "unknown" and said("is_ready") == "[fail]"
        robot.start()
        assert said("get_phase") == "run" and said("is_ready") == "[ok]"
        assert said("get_level") == "0" and said("get_robot") == "r"
        assert said("get_devices") == '("a open")'
        assert said("help").startswith('[many] ("*** Available commands:" get_phase')
        assert said("retry a") == "[ok]"
        assert said("nonsense").startswith("[fail]")
        assert not over.is_set()
        assert said("quit") == "bye" and over.is_set()
        over.clear()
        with Answers.connect(name, names=network) as typed:
            assert typed.get_robot() == "r" and typed.exit() == "bye" and over.is_set()
    robot.stop()


def test_the_name_of_the_port() -> None:
    assert port_name("/icub") == port_name("icub") == "/icub/yarprobotinterface"
