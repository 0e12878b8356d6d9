"""The ini syntax: every row of the tables was printed by C++ YARP from the same text."""

import logging
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.config.ini import LONGEST, parse_ini, read_ini

ENVIRONMENT = {"HOME": "/h"}

ROWS = [
    # joining lines
    ('a (1 2\n3)\nb "x\ny"\nc 5', "(a (1 23)) (b xy) (c 5)"),
    ("a 1\\\n2\nb 3", "(a 12) (b 3)"),
    ("a \\\\\nb", '(a "\\\\") (b)'),
    ("a (1 2\nb 3", "(a)"),
    ('a "xx\nb 3', "(a)"),
    ("a }\nb 1", "(a)"),
    ("a )\nb 1", "(a)"),
    (")]#{\n\n2 [", ""),
    ("a {1 2\n3}", "(a {1 23})"),
    ("zz list \\\n", "(zz list)"),
    ('# "\nb 1', '("#")'),
    ("a 1 // (\nb 1)\nc", "(a 1) (c)"),
    # comments
    ('url http://x\np /a//b\nq "http://x"', '(p "/a") (q "http://x") (url "http:")'),
    ("h a#b\nx 2# c\n#foo\nz 3 # foo\ny 4\t#foo", '(h "a#b") (x "2#" c) (y 4) (z 3)'),
    ('a "x // y" // z', '(a "x // y")'),
    ('a "x\\"y" // z\nb', '(a "x\\"y" "//" z) (b)'),
    ("a 1 // comment\n// whole\nb 2", "(a 1) (b 2)"),
    ("a,#b", '(a "#b")'),
    ('a " # " # b', '(a " # ")'),
    ("x 1 ; y 2", '(x 1 ";" y 2)'),
    # variables
    ('v $HOME\nw ${HOME}x $(HOME) \\$HOME "$HOME"', '(v "/h") (w "/hx" "/h" "$HOME" "/h")'),
    ("a 5\nb $a ${a}7 $nope $__YARP__ x$", "(a 5) (b 5 57 1 x)"),
    ("a \\\\$HOME", '(a "\\\\/h")'),
    ("b 1 2\na $b", "(a 1) (b 1 2)"),
    ("b (1 2)\na $b", "(a 1 2) (b (1 2))"),
    ("[s]\nx 1\n[]\na $x $s", "(a x 1) (s (x 1))"),
    ("a $HOME/x $HOMEx", '(a "/h/x")'),
    # keys and values
    ("key = v\nk=v\nk2 =v\nk3= v", '(k2 "=v") ("k3=" v) ("k=v") (key v)'),
    ("=\n= 1\n= = 1\na = = b\na=\n", '("=" 1) (a "=" b) ("a=")'),
    (
        "l (1 2 3)\nm a b c\nflag\nn 0x1F -5 1e3 3.5 [abc]",
        "(flag) (l (1 2 3)) (m a b c) (n 31 -5 1000.0 3.5 [abc])",
    ),
    ("a 1\na 2", "(a 2)"),
    ("a 1\r\nb 2\r\n[s]\r\nc 3\r\n", "(a 1) (b 2) (s (c 3))"),
    ("a (b 1) (c 2)", "(a (b 1) (c 2))"),
    ("(a 1)\nb 2", "((a 1)) (b 2)"),
    ('"two words" 3\n5 6', '(5 6) ("two words" 3)'),
    ("a true false null", "(a true false [null])"),
    ("a , b\nc,d e", "(a b) (c d e)"),
    # sections
    (
        "a 1\n[s]\nx 1\nx 2\n[t]\ny 1\n[s]\nz 3\n[]\nq 1",
        "(a 1) (q 1) (s (x 1) (x 2) (z 3)) (t (y 1))",
    ),
    (
        "[grp n1]\nx 1\n[grp n2]\nx 2\n[a b c]\ny 1",
        '("a b c" (y 1)) (grp n1 n2) (n1 (x 1)) (n2 (x 2))',
    ),
    ("  [notsection]\nx 1", "([nots]) (x 1)"),
    ("[ s ]\nx 1", '(" s " (x 1))'),
    ('["q s"]\nx 1', '("\\"q s\\"" (x 1))'),
    ('[grp "n 1"]\nx 1', '(grp "n 1") ("n 1" (x 1))'),
    ("[s] trailing\nx 1", "(s (x 1))"),
    ("[s]x 1", "(s)"),
    ("[s\nx 1", "(false) (x 1)"),
    ("[  ]\nx 1", '("  " (x 1))'),
    ("s 5\n[s]\nx 1", "(s 5 (x 1))"),
    ("[s]\nx 1\n[]\ns 8\n[s]\ny 2", "(s 8 (y 2))"),
    ("list a b\n[list c]\nx 1", "(c (x 1)) (list a b c)"),
    ("[g s]\n[g s]\nx 1", "(g s s) (s (x 1))"),
    ("[include]\nx 1", "(include (x 1))"),
]


@pytest.mark.parametrize(("text", "expected"), ROWS)
def test_text(text: str, expected: str) -> None:
    assert parse_ini(text, ENVIRONMENT).to_text() == expected


INCLUDES = [
    ('[include "inc.ini"]\nb 1', "(b 1) (i 1) (is (j 2))"),
    ("[include inc.ini]", "(i 1) (is (j 2))"),
    ('[s]\nx 1\n[include "inc.ini"]\ny 2', "(i 1) (is (j 2)) (s (x 1)) (y 2)"),
    ('[include S "inc.ini"]\ny 2', "(S (i 1) (is (j 2))) (y 2)"),
    ('[include T S "inc.ini"]\ny 2', "(S (i 1) (is (j 2))) (T S) (y 2)"),
    ('[include "sub/one.ini"]', "(four 3) (one 1) (three 3) (two 2)"),
    ('[include "inc.ini"]\n[include "inc.ini"]', "(i 1) (is (j 2) (j 2))"),
    ('[include S "inc.ini"]\n[include S "inc.ini"]', "(S (i 1) (is (j 2) (j 2)))"),
    ('[include "dir"]\nb 2', "(a 1) (b 2) (s (y 1) (x 1))"),
    ('[include S "dir"]\nb 2', "(S (a 1) (b 1) (s (y 1) (x 1))) (b 2)"),
    ('i 5\n[include "inc.ini"]', "(i 1) (is (j 2))"),
    ('[S]\nk 1\n[include S "inc.ini"]\nz 1', "(S (i 1) (is (j 2)) (k 1)) (z 1)"),
    ('[import ctx "inc.ini"]', "(i 1) (is (j 2))"),
    ('three 9\n[include S "sub/deep/four.ini"]', "(S (four)) (three 9)"),
    ('i 1\n[include i "sub/two.ini"]', "(i (two 2))"),
]


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    files = {
        "inc.ini": "i 1\n[is]\nj 2\n",
        "sub/one.ini": 'one 1\n[include "two.ini"]\n[include "deep/three.ini"]\n',
        "sub/two.ini": "two 2\n",
        "sub/deep/three.ini": 'three 3\n[include "two.ini"]\n[include "four.ini"]',
        "sub/deep/four.ini": "four $three\n",
        "dir/b.ini": "b 1\n[s]\nx 1\n",
        "dir/a.ini": "a 1\n[s]\ny 1\n",
        "dir/c.txt": "c 1\n",
    }
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(("text", "expected"), INCLUDES)
def test_includes(tree: Path, text: str, expected: str) -> None:
    (tree / "main.ini").write_text(text)
    assert read_ini("main.ini").to_text() == expected


def test_a_directory_is_all_its_files(tree: Path) -> None:
    assert read_ini(tree / "dir").to_text() == "(a 1) (b 1) (s (y 1) (x 1))"


def test_includes_are_found_beside_the_file_from_anywhere(
    tree: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir("/")
    assert read_ini(tree / "sub/one.ini").to_text() == "(four 3) (one 1) (three 3) (two 2)"


def test_import_asks_for_the_context(tree: Path) -> None:
    asked = []

    def find(name: str, context: str) -> Path | None:
        asked.append((name, context))
        return tree / "sub/two.ini" if context == "known" else None

    text = '[import known "x.ini"]\n[import unknown "inc.ini"]'
    assert parse_ini(text, find=find).to_text() == "(i 1) (is (j 2)) (two 2)"
    assert asked == [("x.ini", "known"), ("inc.ini", "unknown")]


def test_missing_files_are_skipped_with_a_warning(
    tree: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING, "yarpy.names"):
        assert parse_ini('[include "missing.ini"]\nb 1').to_text() == "(b 1)"
    assert "missing.ini" in caplog.text
    with pytest.raises(OSError):
        read_ini(tree / "missing.ini")


def test_files_that_include_each_other_end(tree: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tree / "loop.ini").write_text('x 1\n[include "loop.ini"]\ny 2\n')
    assert read_ini("loop.ini").to_text() == "(x 1) (y 2)"
    assert "included through" in caplog.text
    (tree / "bomb.ini").write_text('[include a "bomb.ini"]\n' * 1)
    read_ini("bomb.ini")


def test_where_variables_come_from() -> None:
    text = "own file\na $own $env $value"
    read = parse_ini(text, {"env": "E", "value": "no"}, {"value": 7, "own": "caller"})
    assert read.to_text() == "(a caller E no) (own file)"
    assert parse_ini("a $x", values={"x": [1, "b c"]}).group("a") == ["a", 1, "b c"]


def test_auth_conf() -> None:
    group = parse_ini('[AUTH]\nkey "secret"\n').group("AUTH")
    assert group is not None and group.find("key") == "secret"


@given(st.text(alphabet='ab12 \t\n\r"\\()[]{}#/$=,', max_size=80))
def test_any_text(text: str) -> None:
    parse_ini(text, ENVIRONMENT).to_text()


@given(st.binary(max_size=100))
def test_any_file(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "any.ini"
    path.write_bytes(data)
    read_ini(path).to_text()


def test_hundreds_of_brackets() -> None:
    assert parse_ini(f"a {'(' * 3000}{')' * 3000}\nb 1").to_text() == "(b 1)"
    assert parse_ini(f"[{'(' * 3000}{')' * 3000}]\nb 1").to_text() != ""


def test_variables_do_not_multiply_without_end(caplog: pytest.LogCaptureFixture) -> None:
    """Each line makes the next a thousand times as long; what goes beyond the limit is empty."""
    lines = "".join(f'v{n + 1} "{f"$v{n}" * 1000}"\n' for n in range(4))
    with caplog.at_level(logging.WARNING, "yarpy.names"):
        read = parse_ini(f"v0 abcdefgh\n{lines}")
    assert all(len(value) <= LONGEST + 10_000 for value in read.values())
    assert "expand to more than" in caplog.text
