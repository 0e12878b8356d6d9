"""Files of yarpmanager: everything in them, and every slip with its place."""

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.launch.application.application import Arbitrator, Need
from yarpy.kits.launch.application.manager_file import Document, read

WHOLE = """<?xml version="1.0"?>
<APPLICATION>
  <name>My ${n} App</name>
  <description>d</description> <version>2</version>
  <authors><Author email="a@b">Ann</Author></authors>
  <var name="n">1</var>
  <var name="who">/node${n}${later}</var>
  <dependencies><Port>/needed</Port></dependencies>
  <Module>
    <name>grab ber</name> <parameters>--x "a b" ${n}</parameters> <node>${who}</node>
    <stdio>/term</stdio> <workdir>$ENV{HOME}/x</workdir> <deployer>yarpdev</deployer>
    <prefix>/p</prefix> <environment>A=b;C=d e=f</environment> <rank>3</rank> <display>:0</display>
    <geometry>(Pos (x 1))</geometry>
    <dependencies>
      <port timeout="5.5" request="help" reply="ok">/q</port> <port>/r</port>
      <computer><name>fast</name></computer>
    </dependencies>
    <ensure><wait when="START">0.5</wait><wait when="stop">2</wait></ensure>
    <portmap><old>/a</old><new>/b</new></portmap>
  </Module>
  <module><name>view</name><node>localhost</node></module>
  <connection id="C1" persist="TRUE" qos="level:high">
    <from external="true" qos="level:low">/out</from><to>/in</to>
    <protocol>tcp+recv.portmonitor+type.dll+file.x</protocol>
  </connection>
  <connection><output>/o</output><input>/i</input></connection>
  <application><name>Other One</name><prefix>/left</prefix></application>
  <arbitrator><port>/in</port><rule connection="C1">~C2</rule></arbitrator>
</APPLICATION>
"""


def document(text: str) -> Document:
    found = read(text.encode(), "a.xml", {"HOME": "/home"})
    assert found is not None
    return found


def problems(text: str) -> list[str]:
    return [str(one) for one in document(text).application.problems]


def test_everything_in_a_file() -> None:
    whole = document(WHOLE)
    found = whole.application
    assert (found.name, found.description, found.version) == ("My_1_App", "d", "2")
    assert found.authors == ["Ann"] and [need.port for need in found.needs] == ["/needed"]
    grabber, view = found.modules
    assert grabber.command == ["yarpdev", "--device", "grab ber", "--x", "a b", "1"]
    assert (grabber.node, view.node) == ("/node1", "")
    assert (grabber.stdio, grabber.workdir, grabber.prefix) == ("/term", "/home/x", "/p")
    assert grabber.environment == {"A": "b", "C": "d e=f"}
    assert (grabber.rank, grabber.display) == (3, ":0")
    assert (grabber.delay, grabber.rest) == (0.5, 2.0)
    assert grabber.ports == {"/a": "/b"} and grabber.computer == {"name": "fast"}
    first, second = grabber.needs
    assert first == Need("/q", 5.5, "help", "ok", first.where)
    assert (second.port, second.timeout) == ("/r", None)
    one, two = found.connections
    assert (one.source, one.target, one.id, one.persist) == ("/out", "/in", "C1", True)
    assert (one.source_external, one.target_external) == (True, False)
    assert (one.source_qos, one.target_qos) == ("level:low", "level:high")
    assert one.carrier == "tcp+recv.portmonitor+type.dll+file.x"
    assert (two.source, two.target, two.carrier) == ("/o", "/i", "")
    assert [(one.name, one.prefix) for one in whole.nested] == [("Other_One", "/left")]
    assert found.arbitrators == [Arbitrator("/in", {"C1": "~C2"}, found.arbitrators[0].where)]
    assert [str(one) for one in found.problems] == [
        "a.xml:7:3: warning: ${later} is not defined (here), and so is empty"
    ]


def app(*lines: str) -> str:
    return "\n".join(["<application><name>x</name>", *lines, "</application>"])


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "<moduel/>",
            '<moduel> in <application> is ignored: did you mean "module"?',
        ),
        ("<Name>y</Name>", '<Name> in <application> is ignored: write it in lower case, "name"'),
        ("<name>y</name>", ":2:1: warning: <name> is ignored: the first one counts"),
        ("<prefix>/x</prefix>", "<prefix> in <application> is ignored: only that of a nested"),
        ("<module><name>a</name><Node>b</Node></module>", ":2:23: warning: <Node> in <module> is"),
        ("<module><name>a</name><tag>b</tag></module>", "<tag> in <module> is ignored"),
        ("<module/>", ":2:1: error: a module without <name> is left out"),
        ("<module rank='1'><name>a</name></module>", 'the attribute "rank" of <module> is ignored'),
        ("<module><name>a</name><rank>x</rank></module>", 'error: "x" in <rank> is no number'),
        ("<connection><from>/a</from></connection>", "error: a connection without <to> is left"),
        (
            "<connection presist='true'><from>/a</from><to>/b</to></connection>",
            'the attribute "presist" of <connection> is ignored: did you mean "persist"?',
        ),
        (
            "<connection><from external='yes' extrnal='1'>/a</from><to>/b</to></connection>",
            '"extrnal" of <from> is ignored: did you mean "external"?',
        ),
        ("<authors><autor>A</autor></authors>", "<autor> in <authors> is ignored: did you mean"),
        ("<dependencies><prt>/a</prt></dependencies>", "<prt> in <dependencies> is ignored: did"),
        (
            "<module><name>a</name><ensure><wait when='begin'>1</wait></ensure></module>",
            '<wait when="begin"> is ignored',
        ),
        (
            "<module><name>a</name><dependencies><port timeout='soon'>/p</port></dependencies>"
            "</module>",
            'error: "soon" in <port> is no number',
        ),
        ("<module><name>a</name><environment>X</environment></module>", '"X" is no setting of the'),
        ("<var>1</var>", '<var> without attribute "name" is ignored'),
        ("<var name='a'/>", "<var> without text is ignored"),
        ("<arbitrator/>", "an arbitrator without <port> is ignored"),
        ("<application/>", "the nested application has no <name> and is left out"),
        ("<module><name>a<b/></name></module>", "<b> in <name> is ignored"),
        ("<description>5 $</description>", "a $ that begins no ${variable} is left as it is"),
    ],
)
def test_slips(line: str, said: str) -> None:
    found = problems(app(line))
    assert len(found) == 1 and said in found[0]


def test_a_variable_is_told_from_one_that_is_meant() -> None:
    found = problems(app("<var name='robot'>/r</var>", "<description>${robto}</description>"))
    assert found == [
        'a.xml:3:1: warning: ${robto} is not defined (here), and so is empty: did you mean "robot"?'
    ]


def test_whatever_follows_a_variable_and_has_a_name_is_one() -> None:
    whole = app("<var name='a'>1</var>", "<extra name='b'>2</extra>", "<version>${b}</version>")
    found = document(whole).application
    assert found.version == "2"
    assert [str(one) for one in found.problems] == [
        'a.xml:3:1: warning: <extra> defines the variable "b", too'
    ]


def test_variables_of_the_application_around_it_are_known() -> None:
    text = app("<version>${outer}</version>").encode()
    found = read(text, "a.xml", {}, {"outer": "7"})
    assert found is not None and found.application.version == "7"


def test_other_roots_are_none() -> None:
    assert read(b"<module><name>a</name></module>", "a.xml", {}) is None


def test_a_text_that_explodes_is_refused_with_its_place() -> None:
    lines = ["<var name='v0'>xxxxxxxxxxxxxxxx</var>"]
    lines += [f"<var name='v{n}'>${{v{n - 1}}}${{v{n - 1}}}</var>" for n in range(1, 60)]
    with pytest.raises(DecodeError, match=r"a.xml:\d+:1: with its variables"):
        document(app(*lines))


@pytest.mark.parametrize(
    ("node", "many"), [("", 1), ("<node>pc1</node>", 0), ("<node>localhost</node>", 0)]
)
def test_nobody_looks_for_a_computer_that_has_enough(node: str, many: int) -> None:
    found = problems(
        f"<application><name>a</name>\n<module><name>sleep</name>{node}<dependencies>\n"
        "<computer><memory>1</memory></computer></dependencies></module></application>"
    )
    said = 'a.xml:3:1: warning: <computer> chooses none: "sleep" runs on this one, or where'
    assert len(found) == many and all(one.startswith(said) for one in found)


@pytest.mark.parametrize(("node", "many"), [("", 1), ("<node>pc1</node>", 0)])
def test_a_rank_moves_no_program(node: str, many: int) -> None:
    found = problems(
        f"<application><name>a</name><module><name>sleep</name>{node}\n<rank>20</rank></module>"
        "</application>"
    )
    said = 'a.xml:2:1: warning: <rank> chooses no computer: "sleep" runs on this one, or where'
    assert len(found) == many and all(one.startswith(said) for one in found)
