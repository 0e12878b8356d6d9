"""Which application a command means."""

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.console import control
from yarpy.kits.launch.console.chosen import chosen


def test_by_name_by_file_or_the_only_one(runtime, tmp_path, monkeypatch) -> None:
    (tmp_path / "x.toml").write_text("name = 'my app'")
    monkeypatch.chdir(tmp_path)
    assert chosen("robot") == "robot" and chosen("x.toml") == "my_app"
    with pytest.raises(LocalProtocolError, match="no application runs here"):
        chosen("")
    first = control.Record("a")
    serving = control.Control("a", lambda asked: {})
    assert chosen("") == "a"
    second = control.Record("b")
    other = control.Control("b", lambda asked: {})
    with pytest.raises(LocalProtocolError, match="say which: a, b"):
        chosen("")
    for one in (serving, other, first, second):
        one.close()
