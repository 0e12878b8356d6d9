"""Changes to access.toml by a command: what is kept, what is refused, how it is written."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from support.system import NO_LINKS

from yarpy.config.access_edit import allow, refuse
from yarpy.config.access_file import load
from yarpy.errors import AddressError
from yarpy.link.begin.admission import RIGHTS, Peer

RULES = """\
# of the laboratory
[[allow]]
who = "loopback"   # us
may = "all"

[[allow]]
who = ["10.0.0.1", "tls:operator"]
may = ["read", "script"]

[tokens]
panel = "4Zr2kXqyJtWm0v8N"  # the page
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "access.toml"
    path.write_text(RULES)
    path.chmod(0o600)
    return path


def test_a_right_is_given_and_taken_back(file: Path) -> None:
    assert allow(file, "script", "192.168.1.0/24").startswith("192.168.1.0/24 may script from now")
    assert file.read_text(encoding="utf-8").startswith(RULES)
    if sys.platform != "win32":  # there a file has no bits for others
        assert file.stat().st_mode & 0o777 == 0o600
    rules = load(file)
    assert rules.rule_for(Peer("192.168.1.7"), "script", "/arm") is not None
    assert rules.rule_for(Peer("192.168.2.7"), "script", "/arm") is None
    before = file.read_text(encoding="utf-8")
    assert "already" in allow(file, "script", "192.168.1.0/24")
    assert file.read_text(encoding="utf-8") == before
    assert "may no longer script" in refuse(file, "script", "192.168.1.0/24")
    assert file.read_text(encoding="utf-8") == RULES
    assert "nothing to change" in refuse(file, "script", "192.168.1.0/24")
    assert [path.name for path in file.parent.iterdir()] == ["access.toml"]


def test_comments_in_front_of_the_next_rule_stay(file: Path) -> None:
    allow(file, "script", "10.0.0.9")
    file.write_text(
        file.read_text(encoding="utf-8")
        + '\n# the next one\n[[allow]]\nwho = "key"\nmay = "read"\n',
        encoding="utf-8",
    )
    refuse(file, "script", "10.0.0.9")
    assert "# the next one\n[[allow]]" in file.read_text(encoding="utf-8")
    assert "10.0.0.9" not in file.read_text(encoding="utf-8")


def test_the_first_rule_takes_nothing_from_others(tmp_path: Path) -> None:
    file = tmp_path / "new" / "access.toml"
    assert "everybody else keeps" in allow(file, "script", "10.0.0.1")
    rules = load(file)
    for right in RIGHTS:
        assert rules.rule_for(Peer("10.9.9.9"), right, "/arm") is not None
    assert rules.rule_for(Peer("10.9.9.9"), "script", "/arm") is None
    assert rules.rule_for(Peer("10.0.0.1"), "script", "/arm") is not None


@pytest.mark.skipif(bool(NO_LINKS), reason=NO_LINKS)
def test_a_link_is_followed(file: Path) -> None:
    link = file.with_name("link.toml")
    link.symlink_to(file)
    allow(link, "script", "10.0.0.7")
    assert link.is_symlink()
    assert "10.0.0.7" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("change", "right", "who", "told"),
    [
        (allow, "scripts", "10.0.0.1", 'there is no right "scripts"; the rights are read'),
        (allow, "script", "robot", 'nothing is changed: .*"robot" names nobody'),
        (allow, "script", "10.0.0.1/8", "both one computer and a range"),
        (allow, "script", "token:none", 'has no secret: .tokens. needs a line none = "..."'),
        (allow, "script", 'x"\nmay = "all', "characters that cannot be printed"),
        (refuse, "script", "10.0.0.1", "line 6: this rule says more"),
        (refuse, "script", "\x1b[2J", "characters that cannot be printed"),
    ],
)
def test_what_is_refused_changes_nothing(file: Path, change, right, who, told) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(AddressError, match=told):
        change(file, right, who)
    assert file.read_text(encoding="utf-8") == RULES


@pytest.mark.parametrize(
    "text", ['allow = [{who = "key", may = "script"}]\n', "[[allow]]\nwho = 3\n", "\xff\n"]
)
def test_a_file_that_cannot_be_changed_stays(tmp_path: Path, text: str) -> None:
    file = tmp_path / "access.toml"
    file.write_text(text, encoding="latin-1")
    for change in (allow, refuse):
        with pytest.raises(AddressError):
            change(file, "script", "10.0.0.1" if change is allow else "key")
    assert file.read_text(encoding="latin-1") == text


def test_without_a_file_there_is_nothing_to_take(tmp_path: Path) -> None:
    file = tmp_path / "access.toml"
    assert "nothing to change" in refuse(file, "script", "10.0.0.1")
    for change in (allow, refuse):
        with pytest.raises(AddressError, match="so everybody may read"):
            change(file, "read", "10.0.0.1")
    assert not file.exists()
