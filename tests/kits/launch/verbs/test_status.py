"""`yarpy status`: what is shown, and whether all is well."""

from support.commands import SLEEP
from support.wait import wait_until


def test_what_is_not_well_is_in_the_exit_code(cli) -> None:
    path = cli.home / "app.toml"
    path.write_text(f"[programs]\na = {SLEEP}\nb = '/no/such/program'\n")
    with cli.start("up", str(path)) as up:
        up.wait_line(r"\* b failed")
        up.wait_line(r"\* a running")
        done = cli.run("status")
        assert done.returncode == 2
        head, _, first, second = done.stdout.splitlines()
        assert head == "app: 1 of 2 programs run"
        assert first.split()[:2] == ["b", "failed"] and second.split()[:2] == ["a", "running"]
        assert all(len(line) <= 80 for line in done.stdout.splitlines())
        path.write_text(f"[programs]\na = {SLEEP}\n")
        assert cli.run("down").returncode == 0
    with cli.start("up", str(path)) as up:
        wait_until(lambda: cli.run("status", "app").returncode == 0)
        assert cli.run("down").returncode == 0


def test_where_nothing_runs(cli) -> None:
    assert cli.run("status").returncode == 1
