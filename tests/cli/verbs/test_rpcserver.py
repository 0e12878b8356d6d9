"""`yarpy rpcserver`."""

import signal

from support.wait import HANG

import yarpy


def test_a_person_answers(cli):
    """The recorded dialogue."""
    with cli.start("rpcserver", "/rs/a") as process:
        process.write_line("answer (x y)")
        process.write_line("[ok]")
        process.wait_line("active", stream="err")
        said = cli.run("rpc", "/rs/a", input="hello 1 2\n[set] pos 3\n")
        assert said.stdout == "Response: answer (x y)\nResponse: [ok]\n"
        process.end_input()
        said = cli.run("rpc", "/rs/a", input="more\n")
        assert said.stdout == "Response: \n"
        process.wait_line("Waiting", count=4)
        process.signal(signal.SIGINT)
        assert process.wait() == 1
    assert process.stdout == (
        "Waiting for a message...\nMessage: hello 1 2\nReply: \n"
        "Waiting for a message...\nMessage: [set] pos 3\nReply: \n"
        "Waiting for a message...\nMessage: more\nReply: \n"
        "Waiting for a message...\n"
    )
    assert "Interrupting..." in process.stderr


def test_echo_and_stop(cli):
    with cli.start("rpcserver", "--echo", "--stop", "/rs/b") as process:
        process.wait_line("active", stream="err")
        assert cli.run("rpc", "/rs/b", input="a (b c)\n").stdout == "Response: a (b c)\n"
        assert process.wait() == 0


def test_single_closes_each_connection(cli, names):
    with cli.start("rpcserver", "--single", "--echo", "/rs/c") as process:
        process.wait_line("active", stream="err")
        with yarpy.RpcClient("/rs/c", names=names) as client:
            link = client.outputs[0]
            assert client.call("x", timeout=HANG) == ["x"]
            process.wait_line("Waiting", count=2)
            assert client.call("y", timeout=HANG) == ["y"]  # over a new connection
            assert client.outputs[0].stats.messages == 1
            assert link.stats.messages == 1


def test_who_wants_no_reply_gets_none(cli, names):
    with (
        cli.start("rpcserver", "/rs/d") as process,
        yarpy.Port("/rs/writer", names=names) as writer,
    ):
        process.wait_line("active", stream="err")
        writer.connect("/rs/d")
        writer.write(["x"])
        process.wait_line("Waiting", count=2)
    assert process.stdout == ("Waiting for a message...\nMessage: x\nWaiting for a message...\n")


def test_unknown_option(here):
    said = here("rpcserver", "--foo", "/rs/e")
    assert said.code == 1 and "--foo" in said.err
