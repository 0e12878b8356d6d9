"""Includes of robots' files, as they are and as an enemy writes them."""

import os
from pathlib import Path

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.launch.document.element import BadFile, Element
from yarpy.kits.launch.robot import merged
from yarpy.kits.launch.robot.merged import Merge, tags


def test_an_include_is_replaced_by_the_root_of_its_file(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.xml").write_text('<robot><xi:include href="./sub/b.xml"/><x/></robot>')
    (tmp_path / "sub/b.xml").write_text('<devices><xi:include href="./c.xml"/></devices>')
    (tmp_path / "sub/c.xml").write_text("<device/>")
    merge = Merge()
    root = merge.tree(tmp_path / "a.xml")
    assert [child.tag for child in root.children] == ["devices", "x"]
    inner = root.children[0].children[0]
    assert inner.tag == "device" and Path(inner.where.file) == tmp_path / "sub" / "c.xml"
    assert merge.problems == [] and len(merge.files) == 3


def included(tmp_path: Path, include: str, **tagged: list[str]) -> tuple[Element, list[str]]:
    (tmp_path / "a.xml").write_text(f"<robot>\n  {include}\n</robot>")
    (tmp_path / "b.xml").write_text("<device/>")
    merge = Merge(**tagged)
    root = merge.tree(tmp_path / "a.xml")
    return root, [str(one).removeprefix(f"{tmp_path}{os.sep}") for one in merge.problems]


@pytest.mark.parametrize(
    ("attributes", "enabled", "disabled", "there"),
    [
        ("", [], [], True),
        ('enabled_by="x y"', [], [], False),
        ('enabled_by="x y"', ["y"], [], True),
        ('enabled_by="(x y)"', ["y"], [], True),
        ('enabled_by="x"', ["enable_all"], [], True),
        ('disabled_by="z"', [], [], True),
        ('disabled_by="z"', [], ["z"], False),
        ('enabled_by="x" disabled_by="z"', ["x"], ["z"], False),
    ],
)
def test_tags_switch_includes(
    tmp_path: Path, attributes: str, enabled: list[str], disabled: list[str], there: bool
) -> None:
    include = f'<xi:include href="./b.xml" {attributes}/>'
    root, problems = included(tmp_path, include, enabled=enabled, disabled=disabled)
    assert bool(root.children) is there and problems == []


@pytest.mark.parametrize(
    ("include", "said"),
    [
        ("<xi:include/>", 'a.xml:2:3: error: <xi:include> has no attribute "href"'),
        (
            '<xi:include href="./no.xml"/>',
            "no.xml: it cannot be read: No such file or directory",
        ),
        ('<xi:include href="b.xml"/>', 'C++ YARP does not find "b.xml": write "./b.xml"'),
        ('<xi:include hrf="b.xml" href="./b.xml"/>', 'did you mean "href"?'),
        ('<xi:include href="./b.xml" enabled_by="2d"/>', "tags with a digit first"),
        ('<xi:include href="./a.xml"/>', "in a circle: a.xml -> a.xml"),
    ],
)
def test_what_is_odd_is_told_at_its_place(tmp_path: Path, include: str, said: str) -> None:
    _, problems = included(tmp_path, include)
    assert [said in one for one in problems] == [True]
    assert problems[0].startswith("a.xml:2:3: ")


def test_a_circle_of_several_files_ends(tmp_path: Path) -> None:
    for name, other in ("ab", "bc", "ca"):
        (tmp_path / f"{name}.xml").write_text(f'<robot><xi:include href="./{other}.xml"/></robot>')
    merge = Merge()
    merge.tree(tmp_path / "a.xml")
    assert "a.xml -> b.xml -> c.xml -> a.xml" in merge.problems[0].text


def test_files_that_multiply_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(merged, "ROBOT_FILES", 100)
    for number in range(15):
        text = f'<xi:include href="./{number + 1}.xml"/>' * 10
        (tmp_path / f"{number}.xml").write_text(f"<robot>{text}</robot>")
    (tmp_path / "15.xml").write_text("<x/>")
    with pytest.raises(BadFile, match="files of one robot"):
        Merge().tree(tmp_path / "0.xml")


def test_tags_that_multiply_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(merged, "ROBOT_ELEMENTS", 2_000)
    includes = '<xi:include href="./b.xml"/>' * 30
    (tmp_path / "a.xml").write_text(f"<robot>{includes}</robot>")
    (tmp_path / "b.xml").write_text(f"<params>{'<x/>' * (2_000 // 25)}</params>")
    with pytest.raises(BadFile, match="more than 2000 tags"):
        Merge().tree(tmp_path / "a.xml")


def test_files_that_nest_too_deep_are_refused(tmp_path: Path) -> None:
    for number in range(30):
        text = f'<devices><xi:include href="./{number + 1}.xml"/></devices>'
        (tmp_path / f"{number}.xml").write_text(text)
    with pytest.raises(BadFile, match="deep"):
        Merge().tree(tmp_path / "0.xml")


def test_an_entity_is_refused_in_an_included_file_too(tmp_path: Path) -> None:
    (tmp_path / "b.xml").write_text('<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>')
    (tmp_path / "a.xml").write_text('<robot><xi:include href="./b.xml"/></robot>')
    merge = Merge()
    assert merge.tree(tmp_path / "a.xml").children == []
    assert "entities are not read" in merge.problems[0].text


def test_tags_of_the_command_line() -> None:
    assert tags("(a b)") == tags("a b") == ["a", "b"] and tags("") == tags("()") == []
    with pytest.raises(DecodeError, match="no list of tags"):
        tags("(a) (b)")
