"""Who a peer is, and that without rules everybody may do everything."""

from __future__ import annotations

import pytest

from yarpy.link.begin.admission import ASK, RIGHTS, Admission, Gate, Peer, peer_of, same_computer


@pytest.mark.parametrize(
    ("remote", "local", "same"),
    [
        ("127.0.0.1", "127.0.0.1", True),
        ("127.0.0.2", "127.0.0.1", True),
        ("::1", "::1", True),
        ("192.168.1.7", "192.168.1.7", True),  # a program that dialled the address of the network
        ("192.168.1.8", "192.168.1.7", False),
        ("", "", False),
    ],
)
def test_programs_of_this_computer(remote: str, local: str, same: bool) -> None:
    assert same_computer(remote, local) is same


def test_without_rules_everybody_may_do_everything() -> None:
    admission = Gate().admit(Peer("10.0.0.1"))
    assert admission.open
    assert admission.everything
    assert not admission.takes_tokens
    assert [admission.refusal(right) for right in (*RIGHTS, ASK)] == [""] * 6
    assert admission.rights() == [*RIGHTS]
    assert admission.showing("anything") is admission
    assert Admission().allows("register", "/anything")


def test_a_peer_is_shown_with_what_it_proved() -> None:
    assert str(peer_of("10.0.0.1", "10.0.0.2")) == "10.0.0.1"
    assert str(peer_of("127.0.0.1", "127.0.0.1", ["operator"])) == "this computer (tls:operator)"
    assert str(Peer("10.0.0.1", token="panel")) == "10.0.0.1 (token:panel)"
    assert str(Peer()) == "somebody"
