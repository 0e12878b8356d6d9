"""The classical commands: how their arguments are translated, and that they run."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import urllib.request
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from support import fork_server
from support.port import free_block
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.sim.robot import Robot, icub_head

TRANSLATED = [
    ("yarp", "connect /a /b fast_tcp", "connect /a /b fast_tcp"),
    ("yarp", "verbose quiet name list", "name list"),
    ("server", "--write --portdb p.db", "server --write --portdb p.db"),
    ("view", "/view", "view /view"),
    ("view", "", "view /yarpview/img:i"),
    ("view", "--name /v --x 10 --y 20 --w 300 --h 200 --compact", "view /v"),
    ("view", "--PortName /v --OutPortName /click", "view /v --out /click"),
    ("view", "--name /v --remote /cam --carrier udp", "view /v --connect /cam --carrier udp"),
    ("view", "/v --rate 5 --quality 50", "view /v --rate 5 --quality 50"),
    ("scope", "/p --no-browser", "scope /p --name /yarpscope --no-browser"),
    ("scope", "--remote /p", "scope /p --name /yarpscope"),
    ("scope", "--remote /p --index (0 2) --min -1 --max 1 --size 201", None),
    ("hear", "--remote /mic --nodevice", "hear /mic --name /yarphear"),
    ("logger", "--start --unlimited_size --no_stop", "log"),
    ("logger", "--name /l --level ERROR", "log --name /l --level ERROR"),
    ("run", "--server /n --log", "run --server /n --log --end-programs"),
    ("run", "--on /n --kill t 9 --geometry 80x24+0+0", "run --on /n --kill t 9"),
    ("hear", "--name /ears", "hear --name /ears"),
    ("thrift", "--gen yarp:no_doc -o out cam.thrift", "idl thrift --out out cam.thrift"),
    ("thrift", "--check --folder lib cam.thrift", "idl thrift --check --folder lib cam.thrift"),
    ("thrift", "--help", "idl thrift --help"),
    ("thrift", "-gen py -I include -v a.thrift b.thrift", None),
    ("thrift", "--gen ts a.thrift", "idl thrift --gen ts a.thrift"),
    ("thrift", "--I include a.thrift", "idl thrift --folder include a.thrift"),
    ("rosmsg", "--name /typ@/yarpros", "idl rosmsg --name /typ@/yarpros"),
    ("rosmsg", "--help", "idl rosmsg --help"),
    ("rosmsg", "--no-ros true --out . std_msgs/String", "idl rosmsg --python std_msgs/String"),
    ("rosmsg", "--verbose --md5 a/B c/D", "idl rosmsg --md5 a/B c/D"),
    ("rosmsg", "--folder lib --raw a/B", "idl rosmsg --folder lib --raw a/B"),
    ("rosmsg", "a/B --stubs --context c", "idl rosmsg --context c --stubs a/B"),
    ("rosmsg", "std_msgs/String --out .", "idl rosmsg --python std_msgs/String"),
]


@pytest.mark.parametrize(("name", "given", "wanted"), TRANSLATED)
def test_translation(name: str, given: str, wanted: str | None) -> None:
    from yarp import _commands

    words = given.split()
    if "(0" in words:  # one argument of the shell
        place = words.index("(0")
        words[place : place + 2] = ["(0 2)"]
        wanted = "scope /p --index 0,2 --name /yarpscope --min -1 --max 1"
    if "-I" in words:
        wanted = "idl thrift --folder include a.thrift b.thrift"
    translate = getattr(_commands, f"translate_{name}")
    if wanted is None:
        with pytest.raises(_commands.Wrong):
            translate(words)
        return
    assert translate(words) == wanted.split()


def test_the_words_of_a_command_may_stand_alone() -> None:
    from yarp import _commands

    for words in (["--cmd", "sleep", "9", "--hold"], ["--cmd", "sleep 9"]):
        assert _commands.translate_run(words) == ["run", "--cmd", "sleep 9"]


def test_robots(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    from yarp import _commands

    monkeypatch.chdir(tmp_path)
    words = ["--config", "r.xml", "--portprefix", "/z", "--enable_tags", "(a b)", "--verbose"]
    words += ["--allow-deprecated-dtd", "--dryrun", "--speed", "5", "-1"]
    expected = ["robot", "r.xml", "--portprefix", "/z", "--enable_tags", "a b", "--check"]
    assert _commands.translate_robot(words) == [*expected, "--speed", "5", "-1"]
    with pytest.raises(_commands.Wrong, match="give the file of a robot"):
        _commands.translate_robot([])
    (tmp_path / "yarprobotinterface.ini").write_text("config r.xml\n")
    (tmp_path / "r.xml").write_text("<robot/>")
    assert _commands.translate_robot([]) == ["robot", "r.xml"]


def test_the_window_of_yarpmanager_is_a_page() -> None:
    from yarp import _commands

    expected = ["up", "a.xml", "--idle", "--page"]
    assert _commands.translate_manager(["--application", "a.xml"]) == expected
    assert _commands.translate_manager(["a.xml", "--watchdog", "yes"]) == expected
    with pytest.raises(_commands.Wrong, match="--application FILE"):
        _commands.translate_manager([])


def test_what_the_help_shows_is_taken() -> None:
    from yarp import _commands
    from yarpy.kits.thrift.verbs.thrift import command as thrift
    from yarpy.peers.ros.verbs.rosmsg import command as rosmsg

    for command, translate in (
        (rosmsg, _commands.translate_rosmsg),
        (thrift, _commands.translate_thrift),
    ):
        for option in command.params:
            for word in option.opts:
                if word.startswith("--"):
                    value = "ts" if word == "--gen" else "."
                    assert word in translate([word, value, "a/B.thrift"])


@pytest.mark.parametrize(
    ("name", "given", "why"),
    [
        ("thrift", "--gen cpp a.thrift", "this one writes Python"),
        ("thrift", "--gen py", "give a .thrift file"),
        ("thrift", "--nonsense a.thrift", "no option"),
        ("rosmsg", "", "give a type"),
        ("rosmsg", "--nonsense a/B", "no option"),
        ("view", "--nonsense 1", "no option"),
        ("yarp", "config", "yarp-config"),
    ],
)
def test_wrong_arguments(name: str, given: str, why: str) -> None:
    from yarp import _commands

    with pytest.raises(_commands.Wrong, match=why):
        getattr(_commands, f"translate_{name}")(given.split())


def test_config(tmp_path: Path) -> None:
    from yarp._commands import Wrong, config_lines

    environment = {"YARP_CONFIG_HOME": str(tmp_path), "YARP_DATA_HOME": str(tmp_path / "data")}
    (tmp_path / "data/contexts/lab").mkdir(parents=True)
    assert config_lines(["--nameserver"], environment) == [str(tmp_path / "yarp.conf")]
    assert config_lines(["--namespace"], environment) == [str(tmp_path / "yarp_namespace.conf")]
    assert config_lines(["--version"], environment) == [yarpy.__version__]
    assert config_lines(["--help"], environment)[0].startswith("yarp-config --namespace")
    assert config_lines(["context", "--list"], environment)[1] == "lab"
    assert config_lines(["context", "--where", "lab"], environment) == [
        str(tmp_path / "data/contexts/lab")
    ]
    assert config_lines(["robot", "--current"], environment) == ["default"]
    for wrong in ([], ["context", "--where", "none"], ["nonsense"]):
        with pytest.raises(Wrong):
            config_lines(wrong, environment)


def start(program: str, *arguments: str, environment: Mapping[str, str]) -> Process:
    module = "_yarpdev" if program == "main" else "_commands"
    code = f"from yarp.{module} import {program}; {program}()"
    command = [sys.executable, "-c", code, *arguments]
    return Process(command, env=environment, start=fork_server.start)


def test_yarpserver_and_yarp(environment: Mapping[str, str]) -> None:
    number = str(free_block(200))
    with start("yarpserver", "--socket", number, "--local", environment=environment) as server:
        there = {**environment, "YARPY_SERVER": f"127.0.0.1:{number}"}
        for _ in range(100):
            with start("yarp", "name", "list", environment=there) as client:
                if client.wait(HANG) == 0:
                    break
        assert "/root" in client.stdout
        with start("yarp", "exists", "/none", environment=there) as client:
            assert client.wait(HANG) == 1
        server.signal(signal.SIGTERM)
        server.wait(HANG)


def test_yarpidl_thrift(environment: Mapping[str, str], tmp_path: Path) -> None:
    pytest.importorskip("lark")
    source = tmp_path / "camera.thrift"
    source.write_text("service Camera {\n  bool set_speed(1: double speed);\n}\n")
    arguments = ("--gen", "py", "-o", str(tmp_path), str(source))
    with start("yarpidl_thrift", *arguments, environment=environment) as process:
        assert process.wait(HANG) == 0, process.stderr
    assert "set_speed" in (tmp_path / "camera.py").read_text()


def test_wrong_arguments_are_told(environment: Mapping[str, str]) -> None:
    with start("yarpview", "--nonsense", "1", environment=environment) as process:
        assert process.wait(HANG) == 1
    assert process.stderr.strip() == 'error: yarpview: no option "--nonsense"'
    with start("yarp_config", environment=environment) as process:
        assert process.wait(HANG) == 1
    assert process.stderr.startswith("usage: yarp-config")


def test_yarpdev_serves_a_device_until_it_is_asked_to_end(environment: Mapping[str, str]) -> None:
    with (
        yarpy.NameServer(free_block(200)) as server,
        Robot("/icubSim", icub_head((160, 120))),
    ):
        arguments = (
            *("--device", "controlBoard_nws_yarp", "--subdevice", "remote_controlboard"),
            *("--remote", "/icubSim/head", "--local", "/between", "--name", "/again"),
        )
        variables = {**environment, **server.environment}
        with start("main", *arguments, environment=variables) as process:
            process.wait_line("device active in background", timeout=HANG)
            with yarpy.devices.ControlBoard("/again", timeout=HANG) as board:
                assert board.axes > 3
            with yarpy.RpcClient("/again/quit") as client:
                assert client.call("quit") == ["ok"]
            assert process.wait(HANG) == 0, process.stderr
            assert "yarpdev is finished." in process.stdout


def test_yarpdev_serves_a_camera_without_hardware(environment: Mapping[str, str]) -> None:
    with yarpy.NameServer(free_block(200)) as server:
        variables = {**environment, **server.environment}
        arguments = ("--device", "fakeFrameGrabber", "--name", "/eye", "--width", "64")
        with start("main", *arguments, environment=variables) as process:
            process.wait_line("device active in background", timeout=HANG)
            with yarpy.devices.FrameGrabber("/eye") as camera:
                assert camera.image(HANG).array.shape == (240, 64, 3)
            with yarpy.RpcClient("/eye/quit") as client:
                assert client.call("sing") == ["huh?"]
                assert client.call("quit") == ["ok"]
            assert process.wait(HANG) == 0, process.stderr


def test_yarpdev_without_a_device(environment: Mapping[str, str]) -> None:
    with start("main", environment=environment) as process:
        assert process.wait(HANG) == 0
    assert "--device option not specified" in process.stderr
    with start("main", "--list", environment=environment) as process:
        assert process.wait(HANG) == 0
    assert "  remote_controlboard" in {line[:21] for line in process.stdout.splitlines()}
    with start("main", "--device", "nonsense", environment=environment) as process:
        assert process.wait(HANG) == 1
    assert "device not available. yarpdev --list" in process.stderr


@pytest.mark.parametrize("words", [("yarpdev", "--list"), ("yarp-config", "--version")])
def test_who_reads_only_the_beginning_may_go(
    words: tuple[str, str], environment: Mapping[str, str]
) -> None:
    module = "yarp._yarpdev" if words[0] == "yarpdev" else "yarp._commands"
    function = "main" if words[0] == "yarpdev" else "yarp_config"
    code = f"from {module} import {function}; {function}()"
    reading, writing = os.pipe()
    os.close(reading)
    try:
        done = subprocess.run(
            [sys.executable, "-c", code, words[1]],
            stdout=writing,
            stderr=subprocess.PIPE,
            env=environment,
            timeout=HANG,
        )
    finally:
        os.close(writing)
    assert done.stderr == b"" and done.returncode == 0


def test_programs_with_a_page_and_ears_run(environment: Mapping[str, str], tmp_path: Path) -> None:
    with yarpy.NameServer(free_block(200)) as server:
        there = {**environment, **server.environment}
        wav = str(tmp_path / "heard.wav")
        with (
            start("yarpview", "--name", "/see", "--x", "5", environment=there) as view,
            start("yarpscope", "--remote", "/numbers", environment=there) as scope,
            start("yarphear", "--name", "/ear", "--record", wav, environment=there) as ear,
            yarpy.Port("/source") as port,
        ):
            for program, script in ((view, "/view.js"), (scope, "/scope.js")):
                found = program.wait_line(r"is shown at (http\S+)", timeout=HANG)
                with urllib.request.urlopen(found[1], timeout=HANG) as page:
                    assert script in page.read().decode()
            ear.wait_line("Port /ear active", timeout=HANG)
            port.connect("/see")
            port.write(yarpy.Image(np.zeros((4, 6, 3), "u1")))
            port.disconnect("/see")
            port.connect("/ear")
            port.write(yarpy.Sound(np.zeros((1, 800), "i2"), 8000))
            wait_until(lambda: Path(wav).stat().st_size == 44 + 1600, what="it is recorded")
            for program in (view, scope, ear):
                program.signal(signal.SIGINT)
                assert program.wait(HANG) in (0, 130), program.stderr
    assert "--x means nothing in a browser" in view.stderr
    assert Path(wav).stat().st_size == 44 + 1600
