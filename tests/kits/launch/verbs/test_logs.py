"""`yarpy logs`: of one program, of all, and as they come."""

from support.commands import PYTHON


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
        with cli.start("logs", "b", "-f", "-n", "0") as follow:
            assert cli.run("restart", "b").returncode == 0
            follow.wait_line("other")
            assert cli.run("down").returncode == 0
            assert follow.wait() == 0
        assert up.wait() == 0
