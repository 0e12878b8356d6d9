"""The merged view: each parameter with its origin."""

import os
from pathlib import Path

from yarpy import Property
from yarpy.kits.launch.robot.robot_file import load
from yarpy.kits.launch.robot.shown import lines

from .conftest import Write


def test_each_line_says_where_it_is_from(write: Write) -> None:
    write('<params><param name="deep">1</param></params>', "sub/p.xml", whole=True)
    path = write(
        '<param name="top">0</param>\n'
        '<device name="a" type="t"><group name="G"><xi:include href="./sub/p.xml"/></group>\n'
        '<param name="x" extern-name="ex">1</param>\n'
        '<action phase="startup" level="4" type="attach"><param name="all">1</param></action>\n'
        '<action phase="shutdown" level="2" type="park"><param name="target">a</param></action>\n'
        "</device>"
    )
    found = [
        line.replace(f"{path.parent}{os.sep}", "")
        for line in lines(load(path, given=Property(ex=2)))
    ]
    assert found == [
        "robot r, ports /r",
        "  top 0  robot.xml:3:1",
        "device a (t)  robot.xml:4:1",
        "  G:",
        f"    deep 1  {Path('sub', 'p.xml')}:1:9",
        "  x 2  --ex",
        "startup 4: a attach all  robot.xml:6:1",
        "shutdown 2: a park a  robot.xml:7:1",
    ]
