"""`yarpy logs`: of one program, of all, and as they come."""

import pytest
from support.commands import PYTHON

from yarpy.errors import LocalProtocolError
from yarpy.kits.launch.console import control
from yarpy.kits.launch.verbs import logs


def test_lines(cli) -> None:
    path = cli.home / "app.toml"
    path.write_text(
        f"""
[programs.a]
command = [{PYTHON}, "-c", "for n in 1, 2, 3: print('line', n)\\nimport time; time.sleep(600)"]
[programs.b]
command = [{PYTHON}, "-c", "print('other'); import time; time.sleep(600)"]
"""
    )
    with cli.start("up", str(path)) as up:
        up.wait_line(r"a \| line 3")
        up.wait_line(r"b \| other")
        assert cli.run("logs", "a").stdout == "line 1\nline 2\nline 3\n"
        assert cli.run("logs", "a", "-n", "1").stdout == "line 3\n"
        assert sorted(cli.run("logs").stdout.splitlines())[3] == "b | other"
        done = cli.run("logs", "c")
        assert done.returncode == 1 and 'no program is called "c"' in done.stderr
        with cli.start("logs", "b", "-f") as follow:
            follow.wait_line("other")
            assert cli.run("restart", "b").returncode == 0
            follow.wait_line("other", count=2)
            assert cli.run("down").returncode == 0
            assert follow.wait() == 0
        assert up.wait() == 0


@pytest.mark.parametrize(
    ("words", "looks", "shown"),
    [
        (["-n", "0"], [1, 1, 3], "a | 2\na | 3\n"),
        (["-n", "1"], [2, 3], "a | 2\na | 3\n"),
        ([], [0, 1, 2], "a | 1\na | 2\n"),
    ],
)
def test_following_shows_each_line_that_comes(
    here, monkeypatch: pytest.MonkeyPatch, words: list[str], looks: list[int], shown: str
) -> None:
    """Also the first one of all, and none of before where none is wanted."""

    left = [*looks]

    def ask(application: str, /, *, since: int, most: int, **more: str) -> dict[str, list[object]]:
        if not left:
            raise LocalProtocolError("it has ended")
        lines = [[number, "a", str(number)] for number in range(1, left.pop(0) + 1)]
        return {"lines": [one for one in lines if one[0] > since][-most:]}

    monkeypatch.setattr(control, "ask", ask)
    monkeypatch.setattr(logs, "_PERIOD", 0.0)
    said = here("logs", "-f", "--of", "x", *words)
    assert (said.code, said.out) == (0, shown)
