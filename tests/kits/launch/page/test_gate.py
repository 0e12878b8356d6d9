"""Who may use the page of an application."""

import pytest

from yarpy.kits.launch.page.gate import OwnerGate
from yarpy.link.begin.admission import ASK, KNOWN, Peer


@pytest.mark.parametrize("page", [False, True])
def test_the_owner_may_with_a_browser_too(page: bool) -> None:
    found = OwnerGate("/up/a", own=lambda peer: True).admit(Peer("127.0.0.1", True, page=page))
    assert found.allows("read") and found.allows("write") and found.allows("administer")


@pytest.mark.parametrize(
    ("peer", "own"),
    [
        (Peer("127.0.0.1", here=True), False),  # another user
        (Peer("10.0.0.7"), True),  # another computer, whatever the tables say
        (Peer("10.0.0.7", names=("operator",), key=True, token="t"), True),
    ],
)
def test_nobody_else_may(peer: Peer, own: bool) -> None:
    found = OwnerGate("/up/a", own=lambda peer: own).admit(peer)
    assert [right for right in KNOWN if found.allows(right)] == []
    assert "for its user on that computer alone" in found.refusal("read")
    assert found.allows(ASK)
