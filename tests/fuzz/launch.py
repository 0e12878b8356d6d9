"""What kits/launch reads: files of applications and robots, requests to start programs, logs.

Rules: files are read as `yarpy up` and `yarpy robot` read them, and nothing is started. What may be
said of such a file (`checked`, `lines`) is made, too.
"""

from __future__ import annotations

import tempfile
from contextlib import suppress
from pathlib import Path

import yarpy
from yarpy.errors import YarpError
from yarpy.kits.launch.application import manager_file, toml_file
from yarpy.kits.launch.application.load import load
from yarpy.kits.launch.log.log_file import TextFile
from yarpy.kits.launch.log.shown import text_of, told_of
from yarpy.kits.launch.robot import robot_file, shown
from yarpy.kits.launch.run import request as requests
from yarpy.kits.launch.run.allowed import Allowed
from yarpy.kits.launch.run.command_line import joined, variables_of, words_of
from yarpy.port.keep.log_line import LONGEST, read_message
from yarpy.wire.message import DATA, Message

_ENVIRONMENT = {"HOME": "/home/me", "ROBOT": "icub"}
_ALLOWED = Allowed(["/bin/true", "python3 /opt/arm.py"])

APPLICATION = b"""\
<?xml version="1.0"?>
<application><name>walk</name><description>a & b</description><version>1</version>
<var name="robot">icub</var>
<module><name>yarpdev</name><parameters>--name /${robot}/cam "a b"</parameters><node>pc1</node>
<stdio>pc2</stdio><prefix>/left</prefix><environment>A=1;B=2</environment><rank>3</rank>
<dependencies><port timeout="5.0" request="a" reply="b">/x</port></dependencies>
<ensure><wait when="start">0.5</wait></ensure></module>
<connection id="a" persist="true"><from external="true">/a</from><to>/b</to>
<protocol>fast_tcp+recv.priority</protocol></connection>
<arbitrator><port>/b</port><rule connection="a">not a</rule></arbitrator>
<application><name>walk</name><prefix>/p</prefix></application></application>
"""
TOML = b"""\
name = "walk"
[variables]
robot = "icub"
[programs.eye]
command = "yarpy sim --name /${robot} 'a b'"
on = "/nodeA"
needs = ["/icub/x"]
[[connections]]
from = "/a"
to = "/b"
carrier = "fast_tcp"
"""
ROBOT = (
    robot_file.DOCTYPE.encode()
    + b"""
<robot name="icub" build="1" portprefix="/icub"><params><param name="a">1 (2 "x")</param></params>
<devices><device name="cam" type="fake"><param name="b" extern-name="c">5.5</param>
<group name="G"><param name="d">x</param></group>
<paramlist name="networks"><elem name="n">cam</elem></paramlist>
<action phase="startup" level="5" type="attach"><param name="device">cam</param></action>
</device></devices></robot>
"""
)


def read_application(data: bytes) -> None:
    """Read a file of yarpmanager."""
    _application(data, ".xml")
    manager_file.read(data, "x.xml", _ENVIRONMENT, {"robot": "b"})


def read_toml(data: bytes) -> None:
    """Read a file of TOML."""
    _application(data, ".toml")
    toml_file.read(data, "x.toml", _ENVIRONMENT, {"robot": "b"})


def _application(data: bytes, suffix: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"x{suffix}"
        path.write_bytes(data)
        with suppress(YarpError):
            found = load(path, _ENVIRONMENT)
            [str(problem) for problem in found.problems]


def read_robot(data: bytes) -> None:
    """Read a file of yarprobotinterface."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.xml"
        path.write_bytes(data)
        found = robot_file.load(path, enabled=("a",))
        [*shown.lines(found)]


def read_request(data: bytes) -> None:
    """Read a request to start a program, as far as it is started."""
    request = requests.read(Message(DATA, data).as_(yarpy.Bottle))
    request.text("as"), request.number("kill", 1)
    with suppress(YarpError):
        variables = variables_of(request.text("env"))
        words = words_of(request.command)
        with suppress(YarpError):
            assert words_of(joined(words)) == words
        _ALLOWED.check(words, variables, "/nodeA")


def requests_() -> tuple[bytes, ...]:
    """Return some requests."""
    said = (
        '(stdio /nodeB) (cmd "python3 /opt/arm.py \\"/a b\\"") (as x) (env "A=1;YARP_X=2")',
        "(cmd ls) (as x) (workdir /tmp) (log /log)",
        "(kill x 9)",
        "(isrunning x) (code)",
        "(ps)",
    )
    return tuple(yarpy.Bottle.from_text(text).to_bytes() for text in said)


def read_log(data: bytes) -> None:
    """Read a line of a log, show it, keep it."""
    line = read_message(Message(DATA, data))
    if line is None:
        return
    shown_ = text_of(line, coloured=True)
    assert "\n" not in shown_ or line.more.get("backtrace"), "a line that is several"
    assert len(line.text) <= LONGEST
    told_of(line)
    with tempfile.TemporaryDirectory() as folder:
        file = TextFile(Path(folder) / "x.log")
        file.add(line, Message(DATA, data))
        file.close()


def logs() -> tuple[bytes, ...]:
    """Return some lines."""
    said = (
        '(level INFO) (systemtime 1795219554.10) (component a.b) (id c) (message "hot\'s")',
        '(level ERROR) (systemtime 5) (networktime 7.5) (backtrace "a\\nb") (message (1 2))',
        "[WARNING] |a| hot",
        "period 500.000 msec\n",
    )
    return tuple(yarpy.Bottle(["[/log/vm/yarpdev/3]", text]).to_bytes() for text in said)
