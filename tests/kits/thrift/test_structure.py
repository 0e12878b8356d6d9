"""Structs and enums as Python classes."""

import copy
import pickle
from types import ModuleType
from typing import ClassVar

import numpy as np
import pytest
from support.thrift import rows

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.errors import DecodeError
from yarpy.kits import thrift
from yarpy.kits.thrift.structure import same
from yarpy.limit import THRIFT_VALUES


class Mode(thrift.Enum, base=thrift.i8):
    FREE = 0
    HELD = 7


class Node(thrift.Struct):
    """A tree."""

    LIMIT: ClassVar[int] = 3
    name: str = "root"
    mode: Mode = Mode.HELD
    angles: thrift.Float64s = thrift.new(lambda: [1.5])
    children: list["Node"] = thrift.new(list)
    counts: dict[str, thrift.i32] = thrift.new(dict)


ODD = ("Sets", "Nest", "Deep")


@pytest.mark.parametrize("row", rows("structs"), ids=lambda row: row["struct"])
def test_as_cpp_writes_them(row: dict[str, str], capt: ModuleType) -> None:
    cls = getattr(capt, row["struct"].partition("_")[0])
    data = bytes.fromhex(row["hex"])
    made = cls.from_wire(data)
    written = b"".join(codec.encode(made))
    if cls is not capt.Sets:  # which C++ writes wrong
        assert written == data
    assert codec.decode_as(memoryview(written), cls) == made
    if row["struct"] not in ODD:
        assert made.to_text() == row["text"]
    assert cls.from_bottle(made.to_bottle()) == made
    if row["struct"].endswith("_default"):
        assert cls() == made


def test_fields_begin_with_their_defaults() -> None:
    node = Node()
    assert (node.name, node.mode, node.angles.tolist()) == ("root", Mode.HELD, [1.5])
    node.children.append(Node("leaf", children=[]))
    assert Node().children == [] and Node.LIMIT == 3
    assert Node("a", Mode.FREE).mode is Mode.FREE
    with pytest.raises(TypeError, match="unexpected keyword argument 'size'"):
        Node(size=1)  # type: ignore[call-arg]


def test_what_people_see() -> None:
    node = Node("a", angles=np.arange(3.0), children=[Node("b")], counts={"x": 1})
    assert repr(node) == (
        "Node(name='a', mode=<Mode.HELD: 7>, angles=[0.0, 1.0, 2.0], children=[Node(name='b', "
        "mode=<Mode.HELD: 7>, angles=[1.5], children=[], counts={})], counts={'x': 1})"
    )
    assert "<100 float64>" in repr(Node(angles=np.zeros(100)))
    found = node.to_dict()
    assert found["children"][0]["name"] == "b" and found["counts"] == {"x": 1}
    match node:
        case Node(name, mode):
            assert (name, mode) == ("a", Mode.HELD)


def test_equality_looks_into_arrays() -> None:
    assert Node() == Node() and Node("a") != Node("b") and Node() != 5
    assert Node(angles=np.array([1.0])) != Node(angles=np.array([1.0, 2.0]))
    assert Node(children=[Node()]) == Node(children=[Node()])
    assert same({"a": np.zeros(2)}, {"a": [0, 0]}) and not same({"a": 1}, {"b": 1})
    assert hash(Node("a", angles=[1.0])) == hash(Node("a", angles=np.array([1.0])))
    assert hash(Node("a")) != hash(Node("b")) and {Node("a"): 1}[Node("a")] == 1


def test_a_struct_may_be_in_lists_of_itself() -> None:
    tree = Node("a", children=[Node("b", children=[Node("c")]), Node("d")])
    data = b"".join(codec.encode(tree))
    assert Node.from_wire(data) == tree
    assert Bottle.from_bytes(data)[:2] == ["a", 7]


def test_a_struct_in_itself_is_refused() -> None:
    class Endless(thrift.Struct):
        inner: "Endless"

    Endless._namespace = {"Endless": Endless}
    with pytest.raises(
        TypeError, match="Endless contains itself, which YARP's wire cannot say: put it into a list"
    ):
        Endless._flat()

    class Small(thrift.Struct):
        a: thrift.i32 = 0
        b: thrift.i32 = 0

    large = Small
    for _ in range(20):
        large = type("Large", (thrift.Struct,), {"__annotations__": {"a": large, "b": large}})
    with pytest.raises(TypeError, match=f"more than {THRIFT_VALUES}"):
        large._flat()


def test_depth_from_the_network_is_limited() -> None:
    for levels in (600, 3000):
        data = b"".join(codec.encode(Node()))
        for _ in range(levels):
            data = _wrapped(data)
        with pytest.raises(DecodeError, match="lists within each other"):
            Node.from_wire(data)


def _wrapped(data: bytes) -> bytes:
    """A node around that of a message."""
    empty = b"".join(codec.encode(Node()))
    head, tail = empty[:-16], empty[-8:]
    return head + (256).to_bytes(4, "little") + (1).to_bytes(4, "little") + data + tail


def test_copies() -> None:
    node = Node("a", angles=np.arange(3.0), children=[Node("b")])
    assert copy.deepcopy(node) == node
    assert pickle.loads(pickle.dumps(node)) == node


def test_errors_name_the_field() -> None:
    with pytest.raises(TypeError, match=r"Node\.children\[1\]\.name: expected a string, got 5"):
        codec.encode(Node(children=[Node(), Node(name=5)]))  # type: ignore[arg-type]
    with pytest.raises(OverflowError, match=r"Node\.mode: 300 does not fit in i8"):
        codec.encode(Node(mode=300))  # type: ignore[arg-type]
    with pytest.raises(DecodeError, match=r"Node has 5 elements \(name mode .*\), here are 1"):
        Node.from_bottle(["a"])
    with pytest.raises(DecodeError, match=r"Node\.angles: expected a list, got 5"):
        Node.from_bottle(["a", 0, 5, [], []])


def test_arrays_look_at_the_message() -> None:
    data = b"".join(codec.encode(Node(angles=np.arange(20000.0))))
    found = Node.from_wire(memoryview(data))
    assert np.shares_memory(found.angles, np.frombuffer(data, "u1"))


def test_structs_may_extend_structs() -> None:
    class Base(thrift.Struct):
        a: thrift.i32 = 1

    class More(Base):
        b: thrift.i32 = 2

    assert More(b=3).to_bottle() == [1, 3] and More.from_bottle([4, 5]) == More(4, 5)


def test_vocabs_as_enums() -> None:
    class Command(thrift.Enum, base=thrift.vocab):
        HELO = 0x6F6C6568

    class Said(thrift.Struct):
        command: Command = Command.HELO
        all: list[Command] = thrift.new(list)

    Said._namespace = {"Command": Command, "list": list}
    said = Said(all=[Command.HELO])
    data = b"".join(codec.encode(said))
    assert data.hex() == "0001000002000000 0900000068656c6f 010100000100000068656c6f".replace(
        " ", ""
    )
    assert Said.from_wire(data) == said and Command.HELO.word == "helo"
