"""The places of words in a TOML file."""

import pytest

from yarpy.kits.launch.application.toml_place import Places

TEXT = """\
name = "demo"
connections = ["/a -> /b", '/c -> /d']
variables.robot = "/icub"

[programs]
one = "sleep 1"
  'two' = { command = "x", needs = ["/a"] }

[ programs . "three" ]
command = "y"
  needs = [
    "/e",
    { port = "/f" },
  ]
# after = "one"

[[connections]]
from = "/a"
[[connections]]
from = "/g"
"""


@pytest.mark.parametrize(
    ("table", "key", "place"),
    [
        ("", "name", "a:1:1"),
        ("variables", "robot", "a:3:1"),
        ("programs", "", "a:5:1"),
        ("programs", "one", "a:6:1"),
        ("programs.two", "needs", "a:7:4"),  # its table
        ("programs.three", "", "a:9:1"),
        ("programs", "three", "a:9:1"),
        ("programs.three", "command", "a:10:1"),
        ("programs.three", "needs", "a:11:3"),
        ("programs.three", "after", "a:9:1"),  # a comment is none
        ("connections", "from", "a:18:1"),
        ("programs.four", "needs", "a"),
        ("", "needs", "a"),
    ],
)
def test_places(table: str, key: str, place: str) -> None:
    assert str(Places(TEXT, "a").of(table, key)) == place


def test_texts_in_quotes() -> None:
    places = Places(TEXT, "a")
    assert [str(places.spelled(text)) for text in ("/a -> /b", "/c -> /d", "/e")] == [
        *("a:2:17", "a:2:29", "a:12:6"),
    ]
    assert places.spelled("/nobody") is None


def test_hostile_files_take_no_longer_than_others() -> None:
    for text in ("[" * 100_000, "a." * 100_000 + "b = 1", "'\"" * 100_000, "]" * 100_000):
        places = Places(f"{text}\nlast = 1\n", "a")
        assert str(places.of("", "last")) in ("a:2:1", "a")
        assert places.spelled("x") is None
