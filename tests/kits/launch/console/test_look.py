"""The screen of a running application: never wider, never higher, what is wrong first."""

import pytest

from yarpy.kits.launch.console.look import lines, size, text


def program(name: str, state: str = "running", **more: object) -> dict[str, object]:
    found = {"name": name, "state": state, "detail": "", "host": "here", "pid": 7, "cpu": 12.3}
    return {**found, "memory": 45_600_000, "seconds": 1.0, "restarts": 0, "line": "hi", **more}


def link(state: str = "connected", detail: str = "") -> dict[str, object]:
    return {"from": "/a", "to": "/b", "carrier": "", "state": state, "detail": detail, "made": 1}


STATUS = {
    "application": "demo",
    "programs": [
        program("robot", line="a \x1b[31mred\x1b[0m line " + "x" * 200),
        program("camera", "failed", detail="ended with 3", cpu=None, memory=None),
        program("view", host="/nodeB"),
    ],
    "connections": [link(), link("waiting", "for /b")],
}


def test_what_is_shown() -> None:
    found = [line for line, _ in lines(STATUS, 80, 24)]
    assert found[0] == "demo: 2 of 3 programs run, 1 of 2 connections"
    assert found[1].split() == ["name", "state", "host", "cpu", "memory", "last", "line"]
    assert found[2].split()[:2] == ["camera", "failed"] and found[2].endswith("ended with 3")
    assert "12 %" in found[3] and "45.6 MB" in found[3] and "\x1b" not in found[3]
    assert found[5] == "/a -> /b  waiting for /b"


@pytest.mark.parametrize("width", [10, 40, 80, 200])
@pytest.mark.parametrize("height", [3, 8, 24])
def test_nothing_is_wider_or_higher_than_the_screen(width: int, height: int) -> None:
    many = {
        "application": "demo" * 20,
        "programs": [program(f"{'p' * 30}{n}") for n in range(50)],
        "connections": [link("refused", "y" * 300)] * 50,
    }
    shown = text(many, ["news " * 50] * 5, width, height).plain.split("\n")
    assert len(shown) <= max(height, 5) and all(len(line) <= width for line in shown)
    assert any("more" in line for line in shown)


@pytest.mark.parametrize(
    ("count", "expected"), [(None, ""), (5, "5 B"), (1500, "1.5 kB"), (2e9, "2.0 GB")]
)
def test_sizes(count, expected) -> None:
    assert size(count) == expected
