"""The texts of QoS."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import AddressError, DecodeError
from yarpy.peers.ros2.qos import (
    BEST_EFFORT,
    FOREVER,
    KEEP_ALL,
    MANUAL,
    MOST_KEPT,
    PROFILES,
    TRANSIENT_LOCAL,
    Qos,
    asked,
    parse_qos,
    profile,
    promised,
    qos_of_words,
    qos_profile,
)

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


def test_what_is_asked_of_publishers() -> None:
    sure, sensor, kept = Qos(depth=1), PROFILES["sensor"], PROFILES["latched"]
    assert asked([]) == asked([sure]) == asked([sure, kept]) == Qos()
    assert asked([kept, kept]) == Qos(durability=1)
    assert asked([kept, sensor]) == asked([sensor]) == Qos(2)
    assert asked([Qos(2, 1)]) == Qos(2, 1)


def test_what_is_promised_to_subscribers() -> None:
    sure, sensor, kept = Qos(depth=1), PROFILES["sensor"], PROFILES["latched"]
    assert promised([]) == promised([sensor]) == promised([sensor, sure]) == Qos()
    assert promised([sensor, kept]) == Qos(durability=1)


def test_said_in_words() -> None:
    assert qos_profile() == Qos() == qos_profile("default", reliability="reliable")
    assert qos_profile("sensor", depth=20) == Qos(BEST_EFFORT, depth=20)
    assert qos_profile(durability="transient_local", history="keep_all") == Qos(
        durability=TRANSIENT_LOCAL, history=KEEP_ALL
    )
    assert qos_profile(deadline=0.25, lifespan=1, liveliness="manual_by_topic", lease=2.5) == Qos(
        deadline=(0, 250_000_000), lifespan=(1, 0), liveliness=MANUAL, lease=(2, 500_000_000)
    )
    assert qos_of_words(None, {}) is None
    assert qos_of_words("sensor", {"deadline": "250"}) == Qos(2, depth=5, deadline=(0, 250_000_000))
    assert qos_of_words(None, {"depth": "3"}) == Qos(depth=3)
    assert qos_profile(deadline=FOREVER[0]).deadline[0] == FOREVER[0]


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ({"reliability": "fast"}, "is no reliability: it is one of reliable, best_effort"),
        ({"depth": "-1"}, "is no depth"),
        ({"deadline": "nan"}, "is no deadline"),
        ({"lease": "soon"}, "is no lease"),
        ({"colour": "red"}, "is nothing that a QoS has"),
    ],
)
def test_wrong_words(said: dict[str, str], why: str) -> None:
    with pytest.raises(AddressError, match=why):
        qos_of_words(None, said)
