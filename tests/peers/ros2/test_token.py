"""Tokens: the published example, those of an independent implementation, and what is none."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import DecodeError
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.token import ENDPOINTS, Token, gid, parse_token

ZID = "aac3178e146ba6f1fc6e6a4085e77f21"
STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
TYPE = "std_msgs::msg::dds_::String_"
GOLDEN = f"@ros2_lv/0/{ZID}/0/10/MS/%/%/listener/%chatter/{TYPE}/{STRING}/::,10:,:,:,,"
LISTENER = Token(
    0, ZID, 0, 10, "MS", Node("/", "listener"), Key(0, "/chatter", TYPE, STRING), Qos()
)


def test_published_example() -> None:
    assert str(LISTENER) == GOLDEN
    assert parse_token(GOLDEN) == LISTENER
    assert gid(GOLDEN).hex() == "f15f21d2fafc22891bb0db868309bfcb"


@pytest.mark.parametrize("kind", ENDPOINTS)
def test_as_an_independent_implementation_has_them(kind: str) -> None:
    pytest.importorskip("zenoh_ros2_sdk", reason="pip install zenoh_ros2_sdk")
    from zenoh_ros2_sdk.entity import EndpointEntity, EntityKind, NodeEntity
    from zenoh_ros2_sdk.keyexpr import endpoint_liveliness_keyexpr, node_liveliness_keyexpr

    node = NodeEntity(7, ZID, 3, "arm", "/robot/left")
    endpoint = EndpointEntity(
        node, 4, EntityKind(kind), "/robot/pose", TYPE, STRING, "2::,5:,:,:,,"
    )
    ours = Token(7, ZID, 3, 3, "NN", Node("/robot/left", "arm"))
    assert str(ours) == node_liveliness_keyexpr(node)
    assert parse_token(str(ours)) == ours
    key = Key(7, "/robot/pose", TYPE, STRING)
    ours = Token(7, ZID, 3, 4, kind, Node("/robot/left", "arm"), key, Qos(2, depth=5))
    assert str(ours) == endpoint_liveliness_keyexpr(endpoint)
    assert parse_token(str(ours)) == ours


def test_lyrical_says_more() -> None:
    token = parse_token(GOLDEN + "/backends:cpu:")
    assert token.extra == "backends:cpu:"
    assert str(token) == GOLDEN + "/backends:cpu:"


@pytest.mark.parametrize(
    "text",
    [
        *("", "@ros2_lv", GOLDEN[1:], GOLDEN.replace("/%/", "//"), GOLDEN.replace("/MS/", "/XX/")),
        *(GOLDEN.rpartition("/")[0], GOLDEN.replace("/10/", "/x/"), GOLDEN + "x"),
        *(GOLDEN.replace("/0/", "/-1/", 1), GOLDEN + "/" + "a" * 5000),
    ],
)
def test_no_tokens(text: str) -> None:
    with pytest.raises(DecodeError):
        parse_token(text)


@given(st.text(alphabet="@ros2_lv/0%MSN:,a", max_size=60))
def test_any_text(text: str) -> None:
    try:
        parse_token(text)
    except DecodeError:
        pass


def test_gids_differ() -> None:
    tokens = [GOLDEN.replace("/10/", f"/{at}/") for at in range(100)]
    assert len({gid(token) for token in tokens}) == 100
    assert {len(gid(token)) for token in tokens} == {16}
