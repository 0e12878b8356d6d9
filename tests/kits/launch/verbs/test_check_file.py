"""`yarpy check`: applications and robots, each problem with its place."""

import sys

import pytest
from click.testing import CliRunner

from yarpy.kits.launch.verbs.check_file import FEW, command

APPLICATION = f"""<application>
<name>app</name>
<module><Node>localhost</Node><name>{sys.executable}</name></module>
<conection/>
</application>
"""
ROBOT = """<!DOCTYPE robot PUBLIC "-//YARP//DTD yarprobotinterface 3.0//EN" \
"http://www.yarp.it/DTD/yarprobotinterfaceV3.0.dtd">
<robot name="r" portprefix="/r" build="0">
<device name="d" type="simulatedHead"><action phase="startupp" level="1" type="detach"/></device>
</robot>
"""


def check(*words: object) -> tuple[int, list[str]]:
    done = CliRunner().invoke(command, [*map(str, words)], standalone_mode=False)
    if done.exception is not None:
        raise done.exception
    return done.return_value, done.output.splitlines()


def test_an_application_and_a_robot(tmp_path) -> None:
    one, two = tmp_path / "a.xml", tmp_path / "r.xml"
    one.write_text(APPLICATION)
    two.write_text(ROBOT)
    code, lines = check("--offline", one, two)
    assert code == 1
    assert lines == [
        f'{one}:3:9: warning: <Node> in <module> is ignored: write it in lower case, "node"',
        f'{one}:4:1: warning: <conection> in <application> is ignored: did you mean "connection"?',
        "app: 1 program, 0 connections, 2 problems",
        f'{two}:3:39: error: there is no phase "startupp": did you mean "startup"?',
        "r: 1 device, 1 problem",
    ]


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("x.xml", "<application><name>a</nam></application>", ":1:23: error: this is no XML"),
        ("x.xml", "<module/>", ": error: the root of the file is no <application>"),
        ("x.xml", "<aplication/>", ": error: the root of the file is no <application>: did you"),
        ("x.toml", "a = = 1", "error"),
        ("x.xml", "", "error: this is no XML: no element found"),
    ],
)
def test_files_that_are_none(tmp_path, name: str, text: str, said: str) -> None:
    file = tmp_path / name
    file.write_text(text)
    code, lines = check("--offline", file)
    assert code == 1 and len(lines) == 2 and said in lines[0] and lines[0].startswith(str(file))


def test_devices_of_another_computer_are_one_line(tmp_path) -> None:
    file = tmp_path / "r.xml"
    devices = "".join(f'<device name="d{n}" type="cppOnly{n}"/>' for n in range(FEW + 1))
    head, _, _ = ROBOT.partition("<device")
    file.write_text(f"{head}{devices}</robot>")
    code, lines = check(file)
    assert code == 0 and len(lines) == 2
    assert f"warning: {FEW + 1} devices that this computer cannot open: cppOnly0, " in lines[0]
