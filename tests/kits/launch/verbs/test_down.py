"""`yarpy down`; test_up has what it ends."""


def test_where_nothing_runs(cli) -> None:
    done = cli.run("down")
    assert done.returncode == 1 and "no application runs here: `yarpy up FILE`" in done.stderr
    done = cli.run("down", "other")
    assert done.returncode == 1 and 'no application called "other" runs here' in done.stderr
