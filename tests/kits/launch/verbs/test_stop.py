"""`yarpy stop`: without an application, and of nobody; test_start.py has what it does."""


def test_nothing_runs(cli) -> None:
    done = cli.run("stop", "a")
    assert done.returncode == 1 and "no application runs here" in done.stderr
