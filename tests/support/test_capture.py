"""No capture is forgotten: each is replayed somewhere, or named with the reason why not."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

from support.capture import CAPTURES, groups, load_capture
from support.difference import DIFFERENT, LIVE_DIFFERENT, NOT_REPLAYED
from support.table import for_each

TESTS = Path(__file__).parents[1]
REPLAYS = [
    TESTS / "carriers" / "test_capture.py",
    TESTS / "port" / "test_capture.py",
    TESTS / "port" / "test_monitor_capture.py",
    TESTS / "names" / "test_capture.py",
    TESTS / "names" / "test_discovery.py",
    TESTS / "nameserver" / "test_server.py",
    TESTS / "carriers" / "own" / "test_local.py",
    TESTS / "carriers" / "web" / "test_mjpeg.py",
    TESTS / "carriers" / "web" / "test_websocket.py",
    TESTS / "carriers" / "web" / "test_xmlrpc.py",
    TESTS / "interop" / "test_camera.py",
    TESTS / "peers" / "ros" / "test_carrier.py",
    TESTS / "peers" / "ros" / "service" / "test_carrier.py",
]
# Groups and prefixes from which a replay takes every capture there is.
WHOLE_GROUPS = {"administration", "telnet", "malformed"}
WHOLE_PREFIXES = ("conn_tcp", "conn_fast_tcp", "conn_text", "conn_name_ser", "conn_udp",
                  "conn_mcast", "reverse_", "http_")  # fmt: skip
# What tests/peers/ros/test_capture.py takes.
CALLS = "_xmlrpc_"
# What was asked about a connection that is replayed.
QUESTIONS = "_admin_"


def words(path: Path) -> set[str]:
    """Every string that a test file spells out."""
    return {
        node.value
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    }


@cache
def spelled() -> set[str]:
    """Every string that one of the replays spells out."""
    return set().union(*(words(path) for path in REPLAYS))


@for_each([(group, name) for group, names in groups().items() for name in names])
def test_capture_is_replayed_or_excused(capture: tuple[str, str]) -> None:
    group, name = capture
    assert (CAPTURES / f"{name}.json").exists()
    assert load_capture(name).name == name
    if name in NOT_REPLAYED:
        assert len(NOT_REPLAYED[name]) > 20
        return
    replayed = {name, name.partition(QUESTIONS)[0]} & spelled()
    if group == "ros" and CALLS in name:
        return
    assert group in WHOLE_GROUPS or name.startswith(WHOLE_PREFIXES) or replayed, (
        f"{name} is neither replayed nor excused"
    )


def test_groups_are_complete() -> None:
    """As many as were recorded for each group."""
    assert {group: len(names) for group, names in groups().items()} == {
        "connections": 38,
        "administration": 31,
        "names": 45,
        "telnet": 18,
        "malformed": 32,
        "unix_stream": 3,
        "http": 48,
        "mjpeg": 4,
        "websocket": 6,
        "xmlrpc": 8,
        "priority": 8,
        "portmonitor": 25,
        "ros": 53,
    }


def test_differences_are_about_steps_that_exist_and_say_why() -> None:
    for table in (DIFFERENT, LIVE_DIFFERENT):
        for name, differences in table.items():
            capture = load_capture(name)
            for step, difference in differences.items():
                assert capture.steps[step].sender == "a", (name, step)
                assert len(difference.reason) > 20
                following = capture.steps[step + 1 : step + 2]
                if following and isinstance(difference.ours, bytes):
                    assert difference.ours != following[0].data, f"{name} {step} is no difference"


def test_replays_take_whole_groups() -> None:
    """The replays name these groups and prefixes instead of every capture in them."""
    carriers = words(TESTS / "carriers" / "test_capture.py")
    port = words(TESTS / "port" / "test_capture.py")
    assert carriers >= WHOLE_GROUPS
    assert port >= WHOLE_GROUPS
    assert {"conn_", "reverse_"} <= carriers
    assert "http_*.json" in words(TESTS / "carriers" / "web" / "http" / "test_carrier.py")
    assert CALLS in words(TESTS / "peers" / "ros" / "test_capture.py")
