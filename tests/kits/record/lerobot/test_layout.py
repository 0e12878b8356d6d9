"""What a data set says of itself, and what it must not say."""

import json
from typing import Any

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.record.lerobot.layout import DATA_PATH, Feature, parse_info


def info(**changed: Any) -> bytes:
    state = {"dtype": "float32", "shape": [2], "names": {"motors": ["hip", "knee"]}}
    index = {"dtype": "int64", "shape": [1], "names": None}
    features = {"observation.state": state, "index": index, "timestamp": index}
    said = {"codebase_version": "v3.0", "fps": 10, "robot_type": None, "features": features}
    return json.dumps({**said, "data_path": DATA_PATH, **changed}).encode()


def test_features() -> None:
    found = parse_info(info())
    assert (found.fps, found.robot) == (10, "")
    assert found.features == (Feature("observation.state", "float32", (2,), ("hip", "knee")),)
    assert (found.features[0].port, found.features[0].size) == ("/observation/state", 2)


def feature(name: str = "x", dtype: Any = "float32", shape: Any = (1,)) -> dict[str, Any]:
    return {"features": {name: {"dtype": dtype, "shape": shape, "names": None}}}


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"codebase_version": "v2.1"}, "LeRobot's own tools make version 3.0"),
        ({"fps": 0}, "frames a second"),
        ({"fps": 1e-310}, "frames a second"),
        ({"fps": "fast"}, "nothing that can be read"),
        ({"data_path": "../{chunk_index.__class__}"}, "only data/chunk"),
        ({"features": []}, "nothing that can be read"),
        ({"features": {"x": 1}}, "nothing that can be read"),
        (feature("../../etc"), "is no name of a feature"),
        (feature("a/b"), "is no name of a feature"),
        (feature(shape=(-1,)), "shape"),
        (feature(shape=(1 << 20, 1 << 20)), "shape"),
        (feature(shape="x"), "nothing that can be read"),
    ],
    ids=str,
)
def test_what_is_none(changed: dict[str, Any], said: str) -> None:
    with pytest.raises(DecodeError, match=said):
        parse_info(info(**changed))


@pytest.mark.parametrize("text", [b"", b"[]", b"{", b"[" * 100_000, b"\xff", b'{"fps": 1}'])
def test_what_is_no_json(text: bytes) -> None:
    with pytest.raises(DecodeError):
        parse_info(text)


def test_another_version_is_told_in_plain_words() -> None:
    with pytest.raises(DecodeError, match=r"^version v2\.1: LeRobot's own tools"):
        parse_info(b'{"codebase_version": "v2.1", "fps": 10, "features": {}}')
