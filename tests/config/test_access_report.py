"""What `yarpy check --access` tells: the rules, what may be missing, and why."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from yarpy.config.access import Access
from yarpy.config.access_file import parse
from yarpy.config.access_report import WIDTH, defaults, explained, listing, notes, peer_from
from yarpy.errors import AddressError
from yarpy.link.begin.admission import Peer

TEXT = """\
[[allow]]
who = "loopback"
may = "all"

[[allow]]
who = ["192.168.1.0/24", "tls:operator", "token:panel"]
may = ["write", "read"]
ports = ["/icubSim/*", "/cer/*", "/ergocub/*", "/walkman/*", "/another/long/name/*", "/more/*"]

[tokens]
panel = "4Zr2kXqyJtWm0v8N"
"""


@pytest.fixture
def access() -> Access:
    return parse(TEXT, "/etc/access.toml")


def test_all_rules(access: Access) -> None:
    lines = listing(access)
    assert lines[:9] == [
        "The rules of /etc/access.toml:",
        "",
        "1. loopback",
        "   may everything",
        "   ports all",
        "",
        "2. 192.168.1.0/24, tls:operator, token:panel",
        "   may read, write",
        "   ports /icubSim/*, /cer/*, /ergocub/*, /walkman/*, /another/long/name/*,",
    ]
    assert lines[-1] == "Web tokens: panel"
    assert max(map(len, lines)) <= WIDTH


def test_without_a_file() -> None:
    file = Path("/home/me/.config/yarp/access.toml")
    lines = defaults(file, "this computer alone")
    assert lines[0] == f"There is no access.toml; it would be {file}."
    assert lines[-1].endswith("now this computer alone.")
    assert max(map(len, lines)) <= WIDTH
    allowed, told = explained(None, "10.0.0.1", "attach", "/arm")
    assert allowed
    assert "whoever reaches /arm may attach (scripts where" in " ".join(told)


@pytest.mark.parametrize(
    ("who", "right", "port", "allowed", "told"),
    [
        ("loopback", "attach", "/a", True, "yes: rule 1 (line 1): loopback may all: all ports"),
        ("127.0.0.1", "read", "/a", True, "rule 1"),
        ("192.168.1.9", "write", "/cer/arm", True, "yes: rule 2 (line 5): 192.168.1.0/24, "),
        ("10.0.0.1,token:panel", "read", "/cer/arm", True, "rule 2"),
        (
            "192.168.1.9",
            "administer",
            "/cer/arm",
            False,
            "no: no rule lets 192.168.1.9 administer /cer/arm rule 1 (line 1) lets others: "
            "loopback rule 2 (line 5) names them, but lets them only read, write",
        ),
        ("tls:operator", "read", "/arm", False, "rule 2 (line 5) names them, but is for /icubSim"),
        ("tls:guest", "read", "/cer/arm", False, "lets others: 192.168.1.0/24, tls:operator"),
        ("key", "administer", "/arm", False, "no: no rule lets key administer /arm"),
    ],
)
def test_why(access: Access, who: str, right: str, port: str, allowed: bool, told: str) -> None:
    found, lines = explained(access, who, right, port)
    assert found is allowed
    assert told in " ".join(line.strip() for line in lines)
    assert max(map(len, lines)) <= WIDTH


@pytest.mark.parametrize(
    ("who", "right", "port", "told"),
    [
        ("robot.lab", "read", "/a", '"robot.lab" names nobody: write an address'),
        ("", "read", "/a", '"" names nobody'),
        ("tls:", "read", "/a", '"tls:" names nobody'),
        ("token:view", "read", "/a", 'no web token is called "view" in /etc/access.toml: panel'),
        (
            "loopback",
            "wirte",
            "/a",
            'there is no right "wirte"; the rights are read, write, administer, attach',
        ),
        ("loopback", "read", "a", '"a" is not the name of a port'),
    ],
)
def test_what_cannot_be_meant(access: Access, who: str, right: str, port: str, told: str) -> None:
    with pytest.raises(AddressError, match=told):
        explained(access, who, right, port)


def test_who_is_somebody() -> None:
    assert peer_from("10.0.0.1,tls:a,tls:b,key,token:t", None) == Peer(
        "10.0.0.1", False, ("a", "b"), True, "t"
    )
    assert peer_from("loopback", None) == peer_from("127.0.0.1", None)


def test_what_may_be_missing(tmp_path: Path) -> None:
    file = tmp_path / "access.toml"
    rules = (
        '[[allow]]\nwho = ["tls:a", "key"]\nmay = "read"\n[tokens]\nspare = "4Zr2kXqyJtWm0v8N"\n'
    )
    file.write_text(rules)
    file.chmod(0o644)
    found = [*notes(parse(rules, file), authority=tmp_path / "ca.pem", has_key=False)]
    words = ["loopback", "ca.pem", "auth.conf", "token spare", "chmod 600"]
    if sys.platform == "win32":
        del words[4]  # its files have no bits for others
    for note, word in zip(found, words, strict=True):
        assert word in note
    file.chmod(0o600)
    (tmp_path / "ca.pem").touch()
    rest = rules.replace('"key"', '"key", "loopback", "token:spare"')
    assert [*notes(parse(rest, file), authority=tmp_path / "ca.pem", has_key=True)] == []
