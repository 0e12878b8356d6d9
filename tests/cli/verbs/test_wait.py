"""`yarpy wait`."""

from support.port import free_port

import yarpy


def test_a_port_that_comes(cli, names):
    with cli.start("wait", "/wait/a") as process:
        process.wait_line(r"^Waiting for /wait/a\.\.\.$", stream="out")
        with yarpy.Port("/wait/a", names=names):
            assert process.wait() == 0


def test_a_connection_that_comes(cli, names):
    with (
        yarpy.Port("/wait/b", names=names) as b,
        yarpy.Port("/wait/c", names=names, callback=lambda message: None),
        cli.start("wait", "/wait/b", "/wait/c") as process,
    ):
        process.wait_line(r"^Waiting for /wait/b->/wait/c\.\.\.$", stream="out")
        b.connect("/wait/c")
        assert process.wait() == 0


def test_the_time_is_over(here):
    code, out, err = here("wait", "/wait/never", "--timeout", "0.2")
    assert (code, out) == (1, "Waiting for /wait/never...\n")
    # Behind a warning where the name server takes longer than these.
    assert 'error: the 0.2 s are over: no port "/wait/never" is registered' in err


def test_a_wait_that_ends_early_is_not_said_again(here, monkeypatch):
    monkeypatch.setattr(yarpy, "wait_for", lambda *_: False)
    _, out, _ = here("wait", "/wait/never", "--timeout", "0.05")
    assert out == "Waiting for /wait/never...\n"


def test_it_says_what_is_missing(here, names):
    with yarpy.Port("/wait/here", names=names):
        assert here("wait", "/wait/here", "/wait/there", "--timeout", "0.2")[2].endswith(
            'error: the 0.2 s are over: "/wait/here" is there, but does not send to "/wait/there"\n'
        )


def test_a_name_server_that_comes(cli, tmp_path):
    port = free_port()
    cli.environment["YARPY_SERVER"], before = f"127.0.0.1:{port}", cli.environment["YARPY_SERVER"]
    try:
        with cli.start("wait", "/wait/d") as process:
            process.wait_line("waiting for one", stream="err")
            with (
                yarpy.NameServer(port) as server,
                yarpy.Port("/wait/d", names=server.client),
            ):
                assert process.wait() == 0
    finally:
        cli.environment["YARPY_SERVER"] = before


def test_what_is_there_when_the_time_is_over(here, names):
    with yarpy.Port("/wait/late", names=names):
        code, _, err = here("wait", "/wait/late", "--timeout", "0")
    assert (code, err) == (0, "")
