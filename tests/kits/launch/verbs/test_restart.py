"""`yarpy restart`: one program, by name."""

from support.commands import SLEEP


def test_it_is_started_again(cli) -> None:
    path = cli.home / "app.toml"
    path.write_text(f"[programs]\na = {SLEEP}\nb = {SLEEP}\n")
    with cli.start("up", str(path)) as up:
        up.wait_line(r"\* a running")
        up.wait_line(r"\* b running")
        assert cli.run("restart", "a").returncode == 0
        up.wait_line(r"\* a running", count=2)
        assert up.stdout.count("* b running") == 1
        done = cli.run("restart", "c", "--of", "app")
        assert done.returncode == 1 and 'no program is called "c"' in done.stderr
        assert cli.run("down", "app").returncode == 0
