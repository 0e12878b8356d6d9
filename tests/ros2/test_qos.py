"""The texts of QoS."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import AddressError, DecodeError
from yarpy.ros2.qos import MOST_KEPT, PROFILES, Qos, parse_qos, profile

GOLDEN = {
    "::,10:,:,:,,": Qos(),
    "2::,5:,:,:,,": Qos(2, depth=5),
    ":1:,1:,:,:,,": Qos(durability=1, depth=1),
    "::2,:,:,:,,": Qos(history=2, depth=42),
    "::,10:1,500:,:3,2,": Qos(deadline=(1, 500), liveliness=3, lease=(2, 854775807)),
}


@pytest.mark.parametrize("text", GOLDEN)
def test_golden_texts(text: str) -> None:
    assert str(GOLDEN[text]) == text
    assert parse_qos(text) == GOLDEN[text]


def test_depth_0_is_42() -> None:
    assert str(Qos(depth=0)) == "::,:,:,:,,"


def test_what_they_mean() -> None:
    assert profile("sensor") is PROFILES["sensor"]
    assert not profile("sensor").reliable
    assert profile(None).reliable
    assert (profile("latched").latched, profile("latched").kept) == (True, 1)
    assert profile("all").kept == Qos(depth=10**9).kept == MOST_KEPT
    with pytest.raises(AddressError, match="default, sensor, latched, all"):
        profile("fast")


def test_no_texts() -> None:
    for text in ("", "::,10:,:,:,", "a:,10:,:,:,,", "::,10:,:,:,,x", "::,-1:,:,:,,"):
        with pytest.raises(DecodeError, match="no QoS"):
            parse_qos(text)


@given(st.text(alphabet="0123456789:,x", max_size=40))
def test_any_text(text: str) -> None:
    try:
        parse_qos(text)
    except DecodeError:
        pass
