"""access.toml: where it is found, what it may contain, and what a mistake in it is told."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import yarpy
from yarpy.config import access_file
from yarpy.config.access_file import current, parse, path
from yarpy.errors import AddressError
from yarpy.link.begin.admission import RIGHTS, Gate, Peer
from yarpy.platform.folders import conf_directory

SAMPLE = """\
# our laboratory
[[allow]]
who = "loopback"
may = "all"

[[allow]]
who = ["192.168.1.0/24", "tls:operator", "token:panel"]
may = ["read", "write"]
ports = ["/icubSim/*"]

[tokens]
panel = "4Zr2kXqyJtWm0v8N"
"""


def test_the_sample() -> None:
    access = parse(SAMPLE)
    first, second = access.rules
    assert (first.who, first.may, first.ports) == (("loopback",), frozenset(RIGHTS), ())
    assert second.who == ("192.168.1.0/24", "tls:operator", "token:panel")
    assert (second.may, second.ports) == (frozenset(("read", "write")), ("/icubSim/*",))
    assert (first.line, second.line) == (2, 6)
    assert access.token_name("4Zr2kXqyJtWm0v8N") == "panel"
    assert access.asks_names


def test_an_empty_file_allows_nothing() -> None:
    assert parse("").rules == ()


RULE = '[[allow]]\nwho = "anyone"\nmay = "read"\n'


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('[[allow]]\nwho = "anyone\n', "this is not TOML: .*line 2"),
        ("[[allow]\n", "this is not TOML"),
        (
            f"{RULE}port = '/a'\n",
            'line 4: "port" has no meaning .* mean "ports".*; this may hold who, may, ports',
        ),
        (
            "# x\n[alow]\n",
            'line 2: "alow" has no meaning .* mean "allow".*; this may hold allow, tokens',
        ),
        ("[allow]\nwho = 'anyone'\n", r"line 1: write each rule below a line \[\[allow\]\]"),
        ("allow = [1]\n", r"line 1: write each rule below a line \[\[allow\]\]"),
        (f"{RULE}\n[[allow]]\nwho = 'key'\n", r"line 5: \[\[allow\]\] needs a line may"),
        ("[[allow]]\nmay = 'read'\n", r"line 1: \[\[allow\]\] needs a line who"),
        (
            f'{RULE}[[allow]]\nwho = "key"\nmay = ["read", "wirte"]\n',
            'line 6: may: there is no right "wirte" .did you mean "write".*; the rights are read, '
            "write, administer, attach, register, script, run, all",
        ),
        ('[[allow]]\nwho = "anyone"\nmay = []\n', "line 3: may: write texts in brackets"),
        ('[[allow]]\nwho = 5\nmay = "read"\n', "line 2: who: write texts in brackets"),
        (
            '[[allow]]\nwho = ["192.168.1.7/24"]\nmay = "read"\n',
            'line 2: who: "192.168.1.7/24" is both one computer and a range: write '
            '"192.168.1.7" or "192.168.1.0/24"',
        ),
        ('[[allow]]\nwho = "192.168.1.0/99"\nmay = "read"\n', "line 2: .* names nobody: write an "),
        ('[[allow]]\nwho = "robot.lab"\nmay = "read"\n', '"robot.lab" names nobody: .*"tls:NAME"'),
        ('[[allow]]\nwho = "tls:"\nmay = "read"\n', '"tls:" names nobody'),
        (
            '[[allow]]\nwho = "token:panel"\nmay = "read"\n',
            r'line 2: who: "token:panel" has no secret: \[tokens\] needs a line panel',
        ),
        (f'{RULE}ports = "icubSim/*"\n', 'line 4: ports: "icubSim/\\*" is not the name'),
        (
            '[tokens]\npanel = "short"\n',
            "line 2: tokens: panel needs at least 16 .*such as panel =",
        ),
        ('[tokens]\npanel = "blanks are not for the web"\n', "line 2: tokens: panel needs"),
        ("[tokens]\npanel = 5\n", "line 2: tokens: write panel ="),
        ('[tokens]\npanel = {file = "none"}\n', "line 2: tokens: .*none cannot be read"),
        ('[tokens]\narm = {curve = "12"}\n', "line 2: tokens: write arm = .*64 hexadecimal"),
        ("[tokens]\narm = {curve = 5}\n", "line 2: tokens: write arm = .*64 hexadecimal"),
        ("tokens = 5\n", r"line 1: tokens: write \[tokens\]"),
    ],
)
def test_a_mistake_is_told_with_its_line(text: str, told: str) -> None:
    with pytest.raises(AddressError, match=told) as caught:
        parse(text, "/etc/access.toml")
    assert str(caught.value).startswith(str(Path("/etc/access.toml")))
    assert str(caught.value).endswith("No port opens until this is fixed")


def test_a_proposed_token_is_fine() -> None:
    with pytest.raises(AddressError) as caught:
        parse('[tokens]\npanel = ""\n')
    found = re.search(r"panel = \"[^\"]+\"", str(caught.value))
    assert found is not None
    parse(f"[tokens]\n{found[0]}\n")


def test_a_token_in_a_file_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "panel.token").write_text("4Zr2kXqyJtWm0v8N\n")
    access = parse('[tokens]\npanel = {file = "panel.token"}\n', tmp_path / "access.toml")
    assert access.token_name("4Zr2kXqyJtWm0v8N") == "panel"


def test_it_is_found_beside_yarp_conf(tmp_path: Path) -> None:
    assert path({"YARP_CONFIG_HOME": "/c"}) == Path("/c/access.toml")
    assert path({"HOME": "/home/me"}) == conf_directory({"HOME": "/home/me"}) / "access.toml"
    assert path({"YARPY_ACCESS": "", "YARP_CONFIG_HOME": "/c"}) == Path("/c/access.toml")
    named = {"YARPY_ACCESS": "/etc/a.toml", "YARP_CONFIG_HOME": "/c"}
    assert path(named) == Path("/etc/a.toml").absolute()


def test_it_is_read_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARPY_ACCESS", raising=False)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path / "without"))
    assert current() is None
    assert type(access_file.gate("/arm")) is Gate
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    (tmp_path / "access.toml").write_text(SAMPLE)
    access = current()
    assert access is not None
    (tmp_path / "access.toml").write_text("")
    assert current() is access
    assert access_file.gate("/icubSim/a").admit(Peer("192.168.1.9")).rights() == ["read", "write"]


def test_a_file_that_is_named_has_to_be_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARPY_ACCESS", str(tmp_path / "none.toml"))
    with pytest.raises(AddressError, match=r"none\.toml cannot be read"):
        current()
    (tmp_path / "folder").mkdir()
    monkeypatch.setenv("YARPY_ACCESS", str(tmp_path / "folder"))
    with pytest.raises(AddressError, match="cannot be read"):
        current()


def test_no_port_opens_with_a_mistake_in_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "access.toml"
    file.write_text('[[allow]]\nwho = "anyone"\nmay = "raed"\n')
    monkeypatch.setenv("YARPY_ACCESS", str(file))
    names = yarpy.LocalNames()
    with pytest.raises(AddressError, match='line 3: may: there is no right "raed"'):
        yarpy.Port("/arm", names=names)
    assert names.query("/arm") is None
    with pytest.raises(AddressError, match="raed"):
        yarpy.NameServer()


def test_public_keys_are_told_from_secrets() -> None:
    key = "0123456789abcdef" * 4
    text = '[[allow]]\nwho = "token:arm"\nmay = "read"\n[tokens]\narm = {curve = "%s"}\n'
    access = parse(text % key.upper())
    assert (access.tokens, access.keys) == ({}, {"arm": key})
