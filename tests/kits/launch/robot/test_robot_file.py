"""Files of robots: what each word means, and what is told of wrong ones."""

import os
from pathlib import Path

import pytest

from yarpy import Property
from yarpy.kits.launch.document.element import BadFile
from yarpy.kits.launch.robot.robot_file import load

from .conftest import DOCTYPE, Write


def told(path: Path) -> list[str]:
    found = load(path)
    return [str(one).replace(f"{path.parent}{os.sep}", "") for one in found.problems]


def test_devices_with_parameters_of_all_kinds(write: Write) -> None:
    path = write(
        """
<params><param name="everywhere">1</param></params>
<devices>
  <param name="common">7</param>
  <device name="mc" type="fakeMotionControl">
    <group name="GENERAL"><param name="Joints">2</param></group>
    <group name="GENERAL"><param name="AxisName">"a" "b"</param></group>
    <param name="name">${portprefix}/arm of ${robotname}</param>
    <subdevice type="inner"><param name="deep">1</param></subdevice>
  </device>
  <device name="nws" type="controlBoard_nws_yarp">
    <paramlist name="list"><elem name="one">x</elem><elem name="two">(1 2)</elem></paramlist>
    <actions>
      <action phase="startup" level="10" type="attach">
        <paramlist name="networks"><elem name="net">mc</elem></paramlist>
      </action>
      <action phase="shutdown" level="5" type="detach"/>
    </actions>
  </device>
</devices>
<device name="alone" type="t"/>
"""
    )
    found = load(path)
    assert [str(one) for one in found.problems] == []
    assert (found.name, found.portprefix, found.reverse) == ("r", "/r", False)
    assert [one.name for one in found.devices] == ["mc", "nws", "alone"]
    motors, server, alone = (found.options(one) for one in found.devices)
    assert motors.group("GENERAL") == ["GENERAL", ["Joints", 2], ["AxisName", "a", "b"]]
    assert motors.group("name") == ["name", "/r/arm", "of", "r"]
    assert motors.find("common") == 7 and motors.find("device") == "fakeMotionControl"
    assert motors.find("subdevice") == "inner" and motors.find("deep") == 1
    assert server.find("list") == ["one", "two"]
    assert server.find("one") == "x" and server.find("two") == [1, 2]
    assert not alone.check("common") and not alone.check("everywhere")
    attach, detach = found.devices[1].actions
    assert attach.targets == {"net": "mc"} and (attach.phase, attach.level) == ("startup", 10)
    assert detach.kind == "detach"


def test_the_command_line_replaces_values_and_the_prefix(write: Write) -> None:
    path = write(
        '<device name="a" type="t"><param name="x" extern-name="ex">1</param>'
        '<param name="y" extern-name="ey">1</param><param name="p">${portprefixnoslash}</param>'
        "</device>"
    )
    found = load(path, given=Property(ex=5, ey=[1, 2], other=1), portprefix="/z")
    values = found.options(found.devices[0])
    assert values.find("x") == 5 and values.find("y") == [1, 2] and values.find("p") == "z"
    assert found.taken == {"ex", "ey"} and found.portprefix == "/z"
    assert [one.given for one in found.devices[0].parameters] == ["--ex", "--ey", ""]


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        ('<device name="a"/>', 'robot.xml:3:1: error: <device> has no attribute "type"'),
        ('<devic name="a" type="t"/>', 'no <devic> may be in <robot>: did you mean "device"?'),
        ('<device name="a" type="t" tipe="x"/>', 'the attribute "tipe" of <device> is ignored'),
        ("<devices>words</devices>", 'warning: the text "words" in <devices> is ignored'),
        ('<param name="a"/>', 'error: the parameter "a" has no value'),
        ('<param name="a">(1</param>', 'warning: the brackets of the parameter "a" do not match'),
        ('<group name="g"/>', 'error: the group "g" is empty'),
        ('<paramlist name="g"/>', 'error: the list "g" is empty'),
        (
            '<param name="a">1</param><param name="a">2</param>',
            'warning: the parameter "a" is there already, at robot.xml:3:1, which counts',
        ),
        (
            '<devices><param name="a">1</param><device name="d" type="t">'
            '<param name="a">2</param></device></devices>',
            'error: the parameter "a" is there already, at robot.xml:3:10',
        ),
        (
            '<device name="a" type="t"/>\n<device name="a" type="t"/>',
            'robot.xml:4:1: error: a device is called "a" already, at robot.xml:3:1',
        ),
    ],
)  # fmt: skip
def test_what_is_odd_is_told_with_its_place(write: Write, inside: str, said: str) -> None:
    assert [said in one for one in told(write(inside))] == [True]


@pytest.mark.parametrize(
    ("action", "said"),
    [
        ('phase="startupp" level="1" type="detach"', '"startupp": did you mean "startup"?'),
        ('phase="x" level="1" type="detach"', 'no phase "x": phases are startup, interrupt1'),
        ('phase="run" level="1" type="detach"', 'warning: an action of phase "run" is never done'),
        ('phase="startup" level="-1" type="detach"', 'the level "-1" is no number from 0 on'),
        ('phase="startup" type="detach"', '<action> has no attribute "level"'),
        ('phase="startup" level="1" type="atach"', 'no action "atach": did you mean "attach"?'),
        ('phase="startup" level="1" type="attach"', "one parameter of device, networks and all"),
        ('phase="startup" level="1" type="park"', "park needs <param"),
    ],
)  # fmt: skip
def test_actions_that_are_wrong_are_told(write: Write, action: str, said: str) -> None:
    found = told(write(f'<device name="a" type="t">\n<action {action}/></device>'))
    assert [said in one for one in found] == [True]
    assert found[0].startswith("robot.xml:4:1: ")


def test_a_network_without_a_device_and_a_target_that_is_none(write: Write) -> None:
    start = '<device name="a" type="t"><action phase="startup" level="1" type="attach">'
    path = write(f'{start}<param name="networks">(n)</param></action></device>')
    assert ['no parameter "n" says' in one for one in told(path)] == [True]
    path = write(f'{start}<param name="device">b</param></action></device>')
    assert ['warning: attach: no device here is called "b"' in one for one in told(path)] == [True]


@pytest.mark.parametrize(
    ("doctype", "said"),
    [
        ("", "warning: C++ YARP refuses a file without this line: <!DOCTYPE robot PUBLIC"),
        (DOCTYPE.replace("robot PUBLIC", "devices PUBLIC"), "the document type is for <devices>"),
        (DOCTYPE.replace("V3.0", "V1.0"), "error: files of version 1 are not read"),
        (DOCTYPE.replace("www.yarp.it", "yarp.it"), "does not know the document type"),
    ],
)
def test_document_types(write: Write, doctype: str, said: str) -> None:
    path = write(f'{doctype}\n<robot name="r"/>', whole=True)
    assert [said in one for one in told(path)] == [True]


def test_a_flag_that_is_none_and_a_name_that_is_missing(write: Write) -> None:
    path = write("", head='reverse-shutdown-action-order="true"')
    assert load(path).reverse
    assert (
        "is neither true nor false" in told(write("", head='reverse-shutdown-action-order="y"'))[0]
    )
    assert 'no attribute "name"' in told(write(f"{DOCTYPE}<robot/>", whole=True))[0]


def test_another_root_is_no_robot(write: Write) -> None:
    with pytest.raises(BadFile, match=r"not <robot>: `yarpy up .*` starts its programs"):
        load(write("<application/>", whole=True))
    with pytest.raises(BadFile, match='the root is <robbot>, not <robot>: did you mean "robot"'):
        load(write("<robbot/>", whole=True))
    with pytest.raises(BadFile, match="cannot be read"):
        load(Path("/nowhere/robot.xml"))
