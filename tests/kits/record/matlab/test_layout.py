"""Where channels are in a file of robometry."""

from typing import Any

from yarpy.kits.record.matlab.layout import LONGEST, field_name, leaves, place


def leaf(name: str = "") -> dict[str, Any]:
    return {"data": [], "timestamps": [], "name": name}


def test_no_name_is_lost() -> None:
    tree: dict[str, Any] = {}
    ports = ["/a/b", "/a", "/a/b/c", "/a:b", "/a.b", "/", "/3"]
    for port in ports:
        place(tree, port, leaf(port))
    assert [*tree] == ["a", "a_", "a_b", "a_b_", "x", "x3"]
    assert [*tree["a"]] == ["b", "b_"]
    assert sorted(port for port, _ in leaves(tree)) == sorted(ports)


def test_names_of_others_are_where_they_are() -> None:
    tree = {"arm": {"state": leaf("state")}, "robot": "demo", "empty": None}
    assert [port for port, _ in leaves(tree)] == ["/arm/state"]


def test_a_tree_without_end() -> None:
    tree: dict[str, Any] = {"x": leaf()}
    tree["tree"] = tree
    assert len({port for port, _ in leaves(tree)}) < 100


def test_long_names() -> None:
    assert len(field_name("x" * 100)) < LONGEST
