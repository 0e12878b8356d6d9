"""Priorities as yarpmanager writes them."""

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.application.quality import read
from yarpy.qos import Qos


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", Qos()),
        ("level:high", Qos(packets="HIGH")),
        ("LEVEL : Critical", Qos(packets="CRIT")),
        ("dscp:AF12; policy:1; priority:30", Qos("SCHED_FIFO", 30, "AF12")),
        ("tos:144", Qos(packets="HIGH")),
    ],
)
def test_texts(text: str, expected: Qos) -> None:
    assert read(text) == expected


@pytest.mark.parametrize("text", ["level:best", "lvl:high", "tos:x", "policy:7", "dscp:AF99"])
def test_what_means_nothing_is_refused(text: str) -> None:
    with pytest.raises(LocalProtocolError, match='qos="'):
        read(text)
