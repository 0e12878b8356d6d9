"""Rules of access: who is meant, what is covered, what is told and logged."""

from __future__ import annotations

import logging
from dataclasses import replace

import pytest

from yarpy.config.access import REMEMBERED, Access, Rule, RuledGate
from yarpy.link.begin.admission import ASK, RIGHTS, Peer

FAR = Peer("192.168.1.9")
HERE = Peer("127.0.0.1", here=True)


def rule(who: str, may: str = "read", ports: str = "") -> Rule:
    return Rule(tuple(who.split()), frozenset(may.split()), tuple(ports.split()))


@pytest.mark.parametrize(
    ("who", "peer", "met"),
    [
        ("anyone", FAR, True),
        ("loopback", FAR, False),
        ("loopback", HERE, True),
        ("192.168.1.9", FAR, True),
        ("192.168.1.0/24", FAR, True),
        ("192.168.2.0/24", FAR, False),
        ("192.168.2.0/24 192.168.1.8/31", FAR, True),  # one of them is enough
        ("fe80::/10", Peer("fe80::1%eth0"), True),
        ("fe80::/10", FAR, False),
        ("0.0.0.0/0", Peer(""), False),  # one who has hung up already
        ("key", FAR, False),
        ("key", replace(FAR, key=True), True),
        ("tls:operator", FAR, False),
        ("tls:operator", replace(FAR, names=("lab", "Operator")), True),
        ("tls:oper", replace(FAR, names=("operator",)), False),
        ("token:panel", replace(FAR, token="panel"), True),
        ("token:panel", replace(FAR, token="view"), False),
        ("token:panel", FAR, False),
    ],
)
def test_who_is_meant(who: str, peer: Peer, met: bool) -> None:
    assert rule(who).meets(peer) is met


@pytest.mark.parametrize(
    ("ports", "port", "covered"),
    [
        ("", "/anything", True),
        ("*", "/anything", True),
        ("/icubSim/*", "/icubSim/head/rpc:i", True),
        ("/icubSim/*", "/icubSim", False),
        ("/icubSim/*", "/icubsim/head", False),
        ("/a /b", "/b", True),
        ("/*/rpc:i", "/icubSim/head/rpc:i", True),
    ],
)
def test_which_ports_are_covered(ports: str, port: str, covered: bool) -> None:
    assert rule("anyone", "read", ports).covers(port) is covered


def test_what_no_rule_allows_is_refused() -> None:
    access = Access((rule("192.168.1.0/24", "read", "/cam*"), rule("loopback", " ".join(RIGHTS))))
    far = RuledGate(access, "/camera").admit(FAR)
    assert far.rights() == ["read"]
    assert not far.everything
    assert not far.open
    assert far.refusal("read") == far.refusal(ASK) == ""
    assert far.refusal("write").startswith(
        "Access refused: 192.168.1.9 may not write to /camera, only read; "
    )
    nobody = RuledGate(access, "/arm").admit(FAR)
    assert nobody.rights() == []
    assert "may not ask anything of /arm; " in nobody.refusal(ASK)
    assert RuledGate(access, "/arm").admit(HERE).everything
    assert not RuledGate(Access(()), "/arm").admit(HERE).allows("read")


def test_rules_add_up() -> None:
    access = Access((rule("anyone", "read"), rule("loopback", "write attach administer", "/arm")))
    assert RuledGate(access, "/arm").admit(HERE).everything
    assert RuledGate(access, "/leg").admit(HERE).rights() == ["read"]


def test_a_name_server_answers_whom_any_rule_is_about() -> None:
    access = Access((rule("192.168.1.0/24", "read register", "/cam/*"),))
    admission = RuledGate(access, "/root", names=True).admit(FAR)
    assert admission.rights() == ["read", "write"]  # commands are messages
    assert not admission.everything
    assert admission.allows("register", "/cam/left")
    assert not admission.allows("register", "/arm")
    assert not admission.allows("register", "...")
    assert "may not register or change /arm; " in admission.refusal("register", "/arm")
    made_up = Access((rule("anyone", "register", "/tmp/*"),))
    assert RuledGate(made_up, "/root", names=True).admit(FAR).allows("register", "...")
    assert not RuledGate(access, "/root", names=True).admit(Peer("10.0.0.1")).rights()


def test_a_token_gives_the_rights_of_its_name() -> None:
    access = Access((rule("token:panel"),), {"panel": "s" * 16, "other": "t" * 16})
    before = RuledGate(access, "/arm").admit(FAR)
    assert before.takes_tokens
    assert not before.allows("read")
    after = before.showing("s" * 16)
    assert after is not None
    assert after.rights() == ["read"]
    assert before.showing("s" * 15) is None
    none = after.showing("")  # of the next request, which shows none
    assert none is not None
    assert none.rights() == []
    assert before.showing("\udcff") is None  # bytes that are no text
    other = after.showing("t" * 16)
    assert other is not None
    assert not other.allows("read")


def test_a_public_key_gives_the_rights_of_its_name() -> None:
    access = Access((rule("token:arm"),), {"panel": "s" * 64}, keys={"arm": "a" * 64})
    before = RuledGate(access, "/arm").admit(FAR)
    assert before.takes_tokens
    after = before.showing("a" * 64, public_key=True)
    assert after is not None
    assert after.rights() == ["read"]
    # Everybody may know it: it is no secret, and a secret is no key.
    assert before.showing("a" * 64) is None
    assert before.showing("s" * 64, public_key=True) is None
    without = RuledGate(Access((rule("token:panel"),), {"panel": "s" * 64}), "/arm").admit(FAR)
    assert without.showing("a" * 64, public_key=True) is without


def test_a_refusal_is_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "yarpy.access")
    access = Access((rule("loopback"),), path="/etc/access.toml")
    for _ in range(3):
        admission = RuledGate(access, "/arm").admit(FAR)
        assert admission.refusal("write")
        assert not admission.allows("read")  # asking is not trying
    assert [record.getMessage() for record in caplog.records] == [
        "/arm: Access refused: 192.168.1.9 may not write to /arm (/etc/access.toml)"
    ]
    admission.refusal("read")
    assert len(caplog.records) == 2


def test_what_was_logged_is_remembered_within_bounds() -> None:
    access = Access(())
    for number in range(2 * REMEMBERED):
        RuledGate(access, f"/{number}").admit(FAR).refusal("read")
    assert len(access._told) == REMEMBERED


def test_certificates_are_asked_for_where_a_rule_has_their_names() -> None:
    assert RuledGate(Access((rule("anyone tls:operator"),)), "/arm").asks_names
    assert not RuledGate(Access((rule("anyone token:tls"),)), "/arm").asks_names


def test_a_rule_reads_as_a_sentence() -> None:
    assert str(rule("loopback key", "write read")) == "loopback, key may read, write: all ports"
    assert str(rule("anyone", " ".join(RIGHTS), "/a /b")) == "anyone may all: /a, /b"
