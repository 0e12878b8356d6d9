"""Names of topics and services of nodes: every spelling of the specification, and what is none."""

import doctest

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.errors import AddressError
from yarpy.names import node_name
from yarpy.names.node_name import NodeName, parse_node_name

SPELLINGS = [
    ("/t1+@/n1~std_msgs/String", "/n1", "/t1", "+", "std_msgs/String"),
    ("/n2=+/t2", "/n2", "/t2", "+", ""),
    ("/n2=/t2", "/n2", "/t2", "", ""),
    ("/n2=-1/t2", "/n2", "/t2", "-1", ""),
    ("/n4+#/t4", "/n4", "/t4", "+", ""),
    ("/n4#/t4", "/n4", "/t4", "", ""),
    ("/t6@/n6~geometry_msgs/Twist", "/n6", "/t6", "", "geometry_msgs/Twist"),
    ("/a:b+@/n7", "/n7", "/a:b", "+", ""),
    ("/m2=-/t2", "/m2", "/t2", "-", ""),
    ("/m4-#/t4", "/m4", "/t4", "-", ""),
    ("/t1-@/m1", "/m1", "/t1", "-", ""),
    ("/t8-1@/m8", "/m8", "/t8", "-1", ""),
    ("/t8+1@/n8", "/n8", "/t8", "+1", ""),
    ("/t81@/n8", "/n8", "/t81", "", ""),
    ("/t8@", "", "/t8", "", ""),
    ("tcp://t8-@/n8", "/n8", "/t8", "-", ""),
    ("/m2=-/t2~a/B~c", "/m2", "/t2", "-", "a/B~c"),
]
ORDINARY = ["/w", "", "...", "=", "/a=b", "/a#b", "/a+", "/a/b:o", "/x~y", "/127.0.0.1:10000"]


@pytest.mark.parametrize(("text", "node", "topic", "category", "kind"), SPELLINGS)
def test_every_spelling_is_read(text: str, node: str, topic: str, category: str, kind: str) -> None:
    assert parse_node_name(text) == NodeName(node, topic, category, kind)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", [item for item in ORDINARY if item != "=/"])
def test_ordinary_names_are_none(text: str) -> None:
    assert parse_node_name(text) is None


@pytest.mark.parametrize("text", ["t9@/n9", "/t9@n9", "@/n9", "n9=/t9"])
def test_a_missing_slash_is_named(text: str) -> None:
    with pytest.raises(AddressError, match="begin with"):
        parse_node_name(text)


def test_the_category_of_what_a_port_does_fills_in() -> None:
    name = parse_node_name("/msg@/test_node")
    assert name is not None
    assert str(name.having("-")) == "/msg-@/test_node"
    assert str(name.having("+1").having("-")) == "/msg+1@/test_node"
    assert name.having("-1").is_service and not name.having("-").is_service


@given(st.text(alphabet="/ab+-1@=#~:", max_size=20))
def test_what_is_written_is_read_again(text: str) -> None:
    try:
        found = parse_node_name(text)
    except AddressError:
        return
    if (
        found is not None
        and ":" not in text
        and not (found.topic + "x").rstrip("1x").endswith(("+", "-"))
    ):
        assert parse_node_name(str(found)) == NodeName(found.node, found.topic, found.category)


def test_examples() -> None:
    assert doctest.testmod(node_name).failed == 0
