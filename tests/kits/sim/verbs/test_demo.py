"""`yarpy demo`: everything that it tells to try, and how it ends."""

import json
import os
import re
import signal
import socket
import sys
import urllib.request
from pathlib import Path

import pytest
from support.command_line import CommandLine
from support.port import free_block, free_port
from support.process import Process
from support.ros2_peer import ros2_router
from support.ros_graph import ros_graph
from support.wait import HANG, wait_until

import yarpy

CHECKOUT = Path(__file__).parents[4]


@pytest.fixture(scope="module")
def lonely(tmp_path_factory: pytest.TempPathFactory) -> CommandLine:
    """The command where nobody has configured anything."""
    return CommandLine(tmp_path_factory.mktemp("demo"))


@pytest.fixture(scope="module")
def demo(lonely: CommandLine):
    with lonely.start("demo") as process:
        process.wait_line("Ctrl-C ends it all", timeout=HANG)
        assert "With ROS" not in process.stdout
        yield process
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 0, process.stderr
        assert process.stdout.endswith("The demo ends.\n")
        assert "Traceback" not in process.stderr


def lines(demo: Process) -> list[str]:
    """What it tells to type."""
    return re.findall(r"^  (\S.*)$", demo.stdout, re.MULTILINE)


def line(demo: Process, *words: str) -> str:
    [found] = [each for each in lines(demo) if all(word in each for word in words)]
    return found.replace("python -m yarpy", f"{sys.executable} -m yarpy")  # there may be no other


def shell(lonely: CommandLine, *commands: str) -> Process:
    """Lines as a person would paste them into a terminal, in the checkout."""
    if sys.platform == "win32":
        script = lonely.home / "lines.bat"
        script.write_text("\n".join(("@echo off", *commands, "")))
        return Process([os.environ["COMSPEC"], "/c", str(script)], env=lonely.environment)
    return Process(["sh", "-c", "\n".join(commands)], env=lonely.environment, cwd=CHECKOUT)


def run(lonely: CommandLine, *commands: str) -> str:
    with shell(lonely, *commands) as process:
        process.end_input()
        assert process.wait(HANG) == 0, process.stderr
        return process.stdout


@pytest.mark.peer("curl")
def test_talking_to_web_apps(demo: Process, lonely: CommandLine):
    """Find the head, tilt it, see that it is tilted: section 7 of "A middle way for robotics
    middleware"."""
    told = json.loads(run(lonely, line(demo, "curl", "query")))
    assert told["type"] == "port"
    assert told["name"] == "/icubSim/head/rpc:i"
    assert (told["ip"], told["carrier"]) == ("127.0.0.1", "tcp")
    assert f":{told['port_number']}/" in line(demo, "curl", "get+encs")
    assert json.loads(run(lonely, line(demo, "curl", "axis=1&angle=45"))) == ["ok"]

    def tilted() -> bool:
        answer = json.loads(run(lonely, line(demo, "curl", "get+encs")))
        assert answer[:2] == ["is", "encs"] and answer[-1] == "ok"
        assert len(answer[2]) == 6
        return bool(abs(answer[2][1] - 45) < 0.001)

    wait_until(tilted)


@pytest.mark.peer("nc")
def test_talking_to_a_human(demo: Process, lonely: CommandLine):
    """Section 8 there: the same without even curl, and what a port says to garbage."""
    with shell(lonely, line(demo, "CONNECT")) as process:
        process.wait_line(r"^\[ok\]", timeout=HANG)
        angles = process.wait_line(r"^\[is\] encs \((.*)\) \[tsta\] .* \[ok\]", timeout=HANG)[1]
        assert abs(float(angles.split()[1])) < 45
    with shell(lonely, line(demo, "hello there")) as process:
        process.wait_line("Protocol not found", timeout=HANG)
        process.wait_line("CONNECT foo", timeout=HANG)


def test_camera_in_a_browser(demo: Process):
    port = re.search(r"http://127\.0\.0\.1:(\d+)/\?req=query", demo.stdout)
    assert port is not None
    query = f"http://127.0.0.1:{port[1]}/?req=query+$port&port=/icubSim/cam/left"
    with urllib.request.urlopen(query, timeout=HANG) as answer:
        camera = json.load(answer)
    where = f"http://127.0.0.1:{camera['port_number']}/?action=stream"
    with urllib.request.urlopen(where, timeout=HANG) as stream:
        assert "multipart/x-mixed-replace" in stream.headers["Content-Type"]
        found = b""
        while found.count(b"\xff\xd8\xff") < 3:
            found += stream.read(1000)
    assert b"Content-Type: image/jpeg" in found


def test_lines_of_yarpy(demo: Process, lonely: CommandLine):
    setting = line(demo, "YARPY_SERVER=")
    assert "registration name /icubSim/cam/right " in run(lonely, setting, line(demo, "name list"))
    assert "Response: [is] encs (" in run(lonely, setting, line(demo, "rpc", "get encs"))
    assert run(lonely, setting, line(demo, "inertial")).startswith("(((")
    name, _, value = setting.split()[-1].partition("=")
    environment = {**lonely.environment, name: value}
    for verb in ("view", "scope"):
        words = [*line(demo, f" {verb} ").split(), "--no-browser"]
        with Process(words, env=environment, cwd=CHECKOUT) as process:
            process.wait_line(r"is shown at http://", timeout=HANG)


def test_page(demo: Process):
    url = re.search(r"(http://127\S+) +<- open this", demo.stdout)
    assert url is not None
    with urllib.request.urlopen(url[1], timeout=HANG) as answer:
        assert b"<title>yarpy robot</title>" in answer.read()
    with urllib.request.urlopen(f"{url[1]}robot", timeout=HANG) as answer:
        assert json.load(answer)["robot"] == "/icubSim"


def test_it_ends_by_itself_beside_another(demo: Process, lonely: CommandLine):
    """The usual numbers are taken: it has others."""
    said = lonely.run("demo", "--seconds", "0.5")
    assert (said.returncode, said.stderr) == (0, "")
    assert said.stdout.endswith("The demo ends.\n")
    assert line(demo, "open this") not in said.stdout


def test_number_of_the_page_is_taken(lonely: CommandLine):
    """Whoever else has the number behind that of the name server."""
    with socket.socket() as other:
        try:
            other.bind(("", 10001))
            other.listen()
        except OSError:
            pass  # somebody else has it: as good
        said = lonely.run("demo", "--seconds", "0.2")
    assert said.returncode == 0
    assert "127.0.0.1:10001/ " not in said.stdout


def test_nothing_is_written_to_the_configuration(demo: Process, lonely: CommandLine):
    assert not (lonely.home / "config").exists()


@pytest.mark.parametrize("options", [[], ["--lan"]])
def test_others_reach_it_only_when_asked(lonely: CommandLine, options: list[str]):
    with lonely.start("demo", *options) as process:
        process.wait_line("Ctrl-C ends it all", timeout=HANG)
        for word in ("open this", "req=get+encs"):
            [number] = re.findall(r":(\d+)/", line(process, word))
            try:
                socket.create_connection(("127.0.0.2", int(number)), 5.0).close()  # not 127.0.0.1
                reached = True
            except ConnectionRefusedError:
                reached = False
            assert reached == bool(options)
        process.signal(signal.SIGINT)
        assert process.wait(HANG) == 0


@pytest.mark.peer("ros", "rosmaster")
def test_it_is_a_node_where_a_ros_master_answers(tmp_path: Path):
    with ros_graph(tmp_path) as graph:
        lonely = CommandLine(tmp_path, {"ROS_MASTER_URI": graph.uri})
        with lonely.start("demo", "--no-browser") as process:
            process.wait_line("Ctrl-C ends it all", timeout=HANG)
            assert f"With ROS, whose master answers at {graph.uri}:" in process.stdout
            echo = line(process, "rostopic echo").split()
            assert "neck_yaw" in graph.tool(*echo, "-n", "1")
            service = line(process, "rosservice call").split()[2]
            assert "SetModelConfiguration" in graph.tool("rosservice", "type", service)
            topic = line(process, "image_view").partition(":=")[2]
            assert "sensor_msgs/Image" in graph.tool("rostopic", "type", topic)
            process.signal(signal.SIGINT)
            assert process.wait(HANG) == 0, process.stderr
            assert process.stderr == ""
        assert "/icubSim" not in graph.tool("rosnode", "list").split()


def test_it_is_a_node_where_a_router_of_ros_2_answers(tmp_path: Path, monkeypatch):
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[ros2]"')
    for variable in ("RMW_IMPLEMENTATION", "ROS_DOMAIN_ID", "ZENOH_SESSION_CONFIG_URI"):
        monkeypatch.delenv(variable, raising=False)
    with ros2_router() as number:
        monkeypatch.setenv("YARPY_ZENOH", f"127.0.0.1:{number}")
        lonely = CommandLine(tmp_path, {"YARPY_ZENOH": f"127.0.0.1:{number}"})
        with lonely.start("demo", "--no-browser") as process:
            process.wait_line("Ctrl-C ends it all", timeout=HANG)
            assert "With ROS 2, over Zenoh (RMW_IMPLEMENTATION=rmw_zenoh_cpp):" in process.stdout
            topic = line(process, "ros2 topic echo").split()[-1]
            with yarpy.BufferedPort("", register=False) as port:
                port.listen_to(f"ros2:/{topic}~sensor_msgs/msg/JointState")
                assert "neck_yaw" in port.read(timeout=HANG).ros.name
            process.signal(signal.SIGINT)
            assert process.wait(HANG) == 0, process.stderr
            assert process.stderr == ""


@pytest.mark.parametrize("uri", ["http://127.0.0.1:{}/", "http://nowhere.invalid:{}/", "nonsense"])
def test_it_is_silent_without_a_ros_master(lonely: CommandLine, tmp_path: Path, uri: str):
    other = CommandLine(tmp_path, {"ROS_MASTER_URI": uri.format(free_port())})
    said = other.run("demo", "--no-browser", "--seconds", "0.2")
    assert (said.returncode, said.stderr) == (0, "")
    assert "ROS" not in said.stdout


def test_its_numbers_begin_where_the_environment_says(tmp_path: Path) -> None:
    number = free_block(2)
    home = CommandLine(tmp_path, {"YARP_PORT_RANGE": str(number)})
    with home.start("demo", "--no-browser", "--seconds", "0") as process:
        assert process.wait(HANG) == 0, process.stderr
    assert f"http://127.0.0.1:{number + 1}/" in process.stdout
    assert f"yarp conf 127.0.0.1 {number}" in process.stdout
