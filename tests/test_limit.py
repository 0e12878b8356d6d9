"""What may come out of what arrives packed, whoever sent it."""

from __future__ import annotations

import ast
import logging
import re
from collections.abc import Iterator
from pathlib import Path
from struct import pack

import numpy as np
import pytest
import simplejpeg
from support.steps import measured

from yarpy.data.bottle import Bottle
from yarpy.data.json import from_json
from yarpy.data.sig import jpeg
from yarpy.data.sig.image import Image
from yarpy.data.text_reader import parse_text
from yarpy.errors import DecodeError
from yarpy.limit import Limits, limits, number_in

FEW = 100_000


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", str(FEW))


def test_what_holds_without_settings() -> None:
    assert limits() == Limits(256 << 20, 64 << 20, 4 << 20)


def test_settings(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    monkeypatch.setenv("YARPY_MAX_PICTURE", "100")
    monkeypatch.setenv("YARPY_MAX_UNPACKED", "lots")
    with caplog.at_level(logging.WARNING, "yarpy"):
        assert limits() == Limits(picture=100)
        limits()
    assert caplog.text.count("YARPY_MAX_UNPACKED='lots' is not a number") == 1


@pytest.mark.parametrize(
    "wire",
    [
        pack("<ii", 256 + 32, FEW + 1) + bytes(FEW + 1),  # of int8, a byte each
        pack("<ii", 256 + 4, FEW + 1) + bytes(4 * FEW + 4),  # of empty strings
        pack("<ii", 256, FEW + 1) + pack("<ii", 1, 7) * (FEW + 1),
        pack("<ii", 256, 3) + (pack("<iiii", 256, 1, 256 + 32, FEW // 2) + bytes(FEW // 2)) * 3,
        pack("<ii", 256, 3) + (pack("<ii", 256 + 32, FEW // 2) + bytes(FEW // 2)) * 3,
    ],
)
def test_elements_of_a_list(few: None, wire: bytes) -> None:
    """A list of numbers is built when its elements are asked for."""
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        Bottle.from_bytes(wire).to_text()


def test_as_many_elements_as_there_may_be(few: None) -> None:
    assert len(Bottle.from_bytes(pack("<ii", 256 + 32, FEW) + bytes(FEW))) == FEW
    assert Bottle.from_bytes(Bottle([bytes(9 * FEW)]).to_bytes())[0] == bytes(9 * FEW)


def test_a_bomb_of_small_numbers_takes_no_memory() -> None:
    """50 MB of the wire would be 2 GB of objects."""
    count = 50_000_000
    wire = pack("<ii", 256 + 32, count) + bytes(count)
    with measured() as peak:
        bottle = Bottle.from_bytes(wire)
        with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
            list(bottle)
        assert len(bottle) == count and bottle.array.sum() == 0
    assert peak.bytes < 1 << 20


@pytest.mark.parametrize(
    "text",
    ["1 " * (FEW + 1), "() " * (FEW + 1), "(1 2 3) " * (FEW // 2), "{" + "1 " * (FEW + 1) + "}"],
)
def test_elements_of_a_text(few: None, text: str) -> None:
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        parse_text(text)


def test_blanks_are_no_elements(few: None) -> None:
    assert parse_text("1" + " " * 9 * FEW + "2") == [1, 2]


@pytest.mark.parametrize("text", ["[" + "1," * FEW + "1]", "[" + "[]," * FEW + "1]"])
def test_elements_of_json(few: None, text: str) -> None:
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        from_json(text)
    assert len(from_json("[" + "1," * (FEW // 2) + "1]")) == FEW // 2 + 1


def test_pixels_of_a_jpeg(monkeypatch: pytest.MonkeyPatch) -> None:
    data = jpeg.encode(Image(np.zeros((100, 100, 3), "u1")))
    monkeypatch.setenv("YARPY_MAX_PICTURE", "20000")
    with pytest.raises(DecodeError, match="YARPY_MAX_PICTURE"):
        jpeg.decode(data)
    monkeypatch.setenv("YARPY_MAX_PICTURE", "40000")
    assert Image.from_wire(jpeg.decode(data)).width == 100


def test_a_large_picture_is_refused_by_its_head_alone() -> None:
    head = simplejpeg.encode_jpeg(np.zeros((8, 8, 3), "u1"))
    at = head.index(b"\xff\xc0") + 5
    bomb = head[:at] + pack(">HH", 60000, 60000) + head[at + 4 :]
    with measured() as peak, pytest.raises(DecodeError, match="YARPY_MAX_PICTURE"):
        jpeg.decode(bomb)
    assert peak.bytes < 1 << 20


def test_a_jpeg_of_a_thousand_scans() -> None:
    """Each would be another walk over all pixels."""
    data = jpeg.encode(Image(np.zeros((16, 16), "u1")))
    scan = data[data.index(b"\xff\xda") : -2]
    with pytest.raises(DecodeError, match="scans"):
        jpeg.decode(data[:-2] + scan * 1000 + data[-2:])


# ---------------------------------------------------------------------------- who has limits where

SOURCE = Path(__file__).parents[1] / "src" / "yarpy"
FUZZ = Path(__file__).parent / "fuzz"
ROOMS = ("carriers", "data", "wire", "peers", "kits/thrift", "kits/wrap", "monitors/script")
LIMIT = re.compile(r"_?(MAX_\w+|\w*LIMIT|\w*LARGEST|\w*DEEPEST|\w*MOST)")
#: limits that stand where they are used
OWN = {
    "wire/stream.py": "compiled, and a default of the contract: a port may give another",
    "wire/framing.py": "compiled; what the protocol says, and half a buffer",
    "wire/datagram.py": "the size of a datagram in C++",
    "data/value.py": "compiled code reads it; the depth of a Bottle in C++",
    "data/stamp.py": "the range of a number on the wire",
    "data/json_plain.py": "the range of a number on the wire",
    "data/sig/jpeg.py": "the size of a comment in the format",
    "peers/ros/message/convert/cloud.py": "the range of a number on the wire",
    "peers/ros/message/convert/picture.py": "the range of a number on the wire",
    "peers/ros/message/source.py": "folders of the owner",
    "peers/ros/message/show.py": "lines that are printed",
    "peers/ros2/name.py": "the length of a name in DDS",
    "peers/ros2/zenoh/firsts.py": "publishers, not what is read of them",
    "peers/ros2/zenoh/graph.py": "what a router tells, not what is read of it",
    "peers/zenoh/tunnel/gateway.py": "connections, not what is read of them",
    "peers/zenoh/tunnel/exchange.py": "connections, not what is read of them",
    "peers/zenoh/reachability.py": "programs that are remembered",
    "peers/mpi/end.py": "what we send at once",
    "peers/mpi/meeting.py": "helpers at a time",
    "peers/zmq/zmtp.py": "the length of a reason in the protocol",
    "peers/zmq/broker.py": "topics that are counted",
    "names/discovery.py": "servers that are told of",
    "monitors/script/control.py": "the range of a number",
}


def own_limits(path: Path) -> Iterator[str]:
    """The numbers of a file that are called limits."""
    text = path.read_text("utf-8")
    for made in ast.parse(text).body if LIMIT.search(text) else ():
        targets = made.targets if isinstance(made, ast.Assign) else [getattr(made, "target", None)]
        numbers = getattr(made, "value", None) is not None and all(
            isinstance(node, (ast.Constant, ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop))
            for node in ast.walk(made.value)  # type: ignore[attr-defined]
        )
        for target in targets:
            if numbers and isinstance(target, ast.Name) and LIMIT.fullmatch(target.id):
                yield target.id


def readers() -> set[Path]:
    """The files of rooms that read what others wrote, and those that are fuzzed."""
    found = {path for room in ROOMS for path in (SOURCE / room).rglob("*.py")}
    for path in FUZZ.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("yarpy."):
                file = SOURCE.joinpath(*str(node.module).split(".")[1:]).with_suffix(".py")
                found |= {file} if file.is_file() else set()
    return found


def test_every_reader_takes_its_limits_from_one_place() -> None:
    files = readers()
    assert len(files) > 150
    owners = {
        str(path.relative_to(SOURCE)): names for path in files if (names := [*own_limits(path)])
    }
    owners.pop("limit.py", None)
    assert {file: names for file, names in owners.items() if file not in OWN} == {}
    assert sorted(OWN) == sorted(owners), "these have no limits of their own any more"


def test_no_limit_is_forgotten() -> None:
    """Each has somebody who keeps to it."""
    tree = ast.parse((SOURCE / "limit.py").read_text("utf-8"))
    names = {
        made.target.id
        for made in tree.body
        if isinstance(made, ast.AnnAssign) and isinstance(made.target, ast.Name)
    }
    used = {
        alias.name
        for path in SOURCE.rglob("*.py")
        if "yarpy.limit" in (text := path.read_text("utf-8"))
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.ImportFrom) and node.module == "yarpy.limit"
        for alias in node.names
    }
    assert {name for name in names if not name.startswith("_")} - used == set()


@pytest.mark.parametrize(
    ("text", "number"),
    [
        *(("0", 0), ("65535", 65535), ("0065", 65), ("65536", None), ("", None), ("-1", None)),
        *((" 1", None), ("1_0", None), ("\u00b2", None), ("\u0664", None), ("9" * 5000, None)),
    ],
)
def test_numbers_in_what_strangers_write(text: str, number: int | None) -> None:
    assert number_in(text, 65535) == number
