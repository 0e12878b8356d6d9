"""Interfaces as plain data."""

import json

import pytest

from yarpy import idl
from yarpy.kits.thrift import describe, loads

TEXT = """\
enum Mode { AUTO = 0, MANUAL = 1 }
/** A part of it. */
struct Region { 1: i32 x = 3, 2: list<double> gains = [1.0], 3: Mode mode = Mode.MANUAL }
struct Tree { 1: string name, 2: list<Tree> parts }
service Base { void rest(); }
service Camera extends Base {
  /** Sets it. */
  bool set_speed(1: double speed, 2: bool exactly = false);
  map<string, Region> find(1: Region where);
  oneway void blink();
}
"""


def test_a_service() -> None:
    module = loads(TEXT, "camera.thrift")
    found = describe(module.Camera)
    assert found == json.loads(json.dumps(found))
    assert (found["name"], found["kind"], found["doc"]) == ("Camera", "service", "")
    methods = {method["name"]: method for method in found["methods"]}
    assert [*methods] == ["rest", "set_speed", "find", "blink"]
    assert methods["set_speed"] == {
        "name": "set_speed",
        "doc": "Sets it.",
        "oneway": False,
        "result": {"type": "bool"},
        "arguments": [
            {"name": "speed", "type": "double"},
            {"name": "exactly", "type": "bool", "default": False},
        ],
    }
    assert methods["find"]["result"] == {"type": "map<string, Region>"}
    assert methods["blink"]["oneway"] and methods["blink"]["result"] is None
    assert found["types"]["Region"] == {
        "name": "Region",
        "kind": "struct",
        "doc": "A part of it.",
        "fields": [
            {"name": "x", "type": "i32", "default": 3},
            {"name": "gains", "type": "list<double>", "default": [1.0]},
            {"name": "mode", "type": "Mode", "default": "MANUAL"},
        ],
    }
    assert found["types"]["Mode"]["values"] == {"AUTO": 0, "MANUAL": 1}


def test_an_object_a_struct_and_an_enum() -> None:
    module = loads(TEXT, "camera.thrift")
    assert describe(module.Camera()) == describe(module.Camera)
    assert describe(module.Mode)["values"] == {"AUTO": 0, "MANUAL": 1}
    region = describe(module.Region)
    assert [one["name"] for one in region["fields"]] == ["x", "gains", "mode"]
    assert [*region["types"]] == ["Mode"]


def test_a_struct_that_holds_itself() -> None:
    assert describe(loads(TEXT, "tree.thrift").Tree)["fields"][1]["type"] == "list<Tree>"


def test_what_is_no_interface() -> None:
    with pytest.raises(TypeError, match="int is of no"):
        describe(3)


def test_the_module_of_a_language_is_found_by_its_name() -> None:
    assert idl.thrift.describe is describe
    with pytest.raises(AttributeError, match="no attribute 'cobol'"):
        _ = idl.cobol
