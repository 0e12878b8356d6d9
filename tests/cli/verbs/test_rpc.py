"""`yarpy rpc`."""

import pytest
from support.ros2_peer import ros2_router
from support.yarp4 import administer_as_yarp4

import yarpy
from yarpy.cli.verbs.rpc import Target, commands_of, many, print_reply
from yarpy.data.yarp4 import is_yarp4
from yarpy.kits.devices import ControlBoardServer


@pytest.fixture(scope="module")
def server_port(names):
    sources = []

    def answer(message):
        sources.append(message.source)
        question = yarpy.Bottle(message.value)
        if question == ["help"]:
            return [yarpy.Vocab("many"), "*** Available commands:", "home", "help", "stop"]
        if question == ["list"]:
            return [yarpy.Vocab("many"), ["a", 1], "two words"]
        return [yarpy.Vocab("ok"), "echo", question]

    with yarpy.RpcServer("/rpc/server", answer, names=names) as port:
        port.sources = sources
        yield port


def test_asks_line_by_line(cli, server_port):
    said = cli.run("rpc", "/rpc/server", input="1 ping 3.14\nhello (a b)\n\nlist\nlast")
    assert (said.returncode, said.stderr) == (0, "")
    assert said.stdout == (
        "Response: [ok] echo (1 ping 3.14000000000000012434)\n"
        "Response: [ok] echo (hello (a b))\n"
        "Response: [ok] echo ()\n"
        "Responses:\n  a 1\n  two words\n"
        "Response: [ok] echo (last)\n"
    )
    assert set(server_port.sources) == {"anon_rpc"}


def test_help_of_a_control_board(cli, names):
    """Which wants two words; C++ ones too."""

    class Arm:
        axis_names = ("elbow",)

        def encoders(self):
            return [0.0]

    with ControlBoardServer("/rpc/arm", Arm(), names=names):
        said = cli.run("rpc", "/rpc/arm/rpc:i", input="help\n")
        assert said.stdout.startswith("Responses:\n  [help] [all]\n")
        assert "  [get] [encs]\n" in said.stdout
        with yarpy.RpcClient("/rpc/arm/rpc:i", names=names) as client:
            assert "get encs" in commands_of(client.call)


def test_under_a_name_of_our_own(cli, server_port):
    assert cli.run("rpc", "text_ack://rpc/server", "/me", input="x\n").returncode == 0
    assert server_port.sources[-1] == "/me"


def test_by_address(here, server_port, monkeypatch):
    import io

    monkeypatch.setattr("sys.stdin", io.StringIO("x\n"))
    said = here("rpc", f"/{server_port.address}")
    assert said[:2] == (0, "Response: [ok] echo (x)\n")


def test_a_target_that_is_not_there(here, names):
    said = here("rpc", "/nobody")
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith('error: Cannot make connection: no port "/nobody"')
    assert "`yarpy rpc --client /me` waits" in said.err
    assert said.err.count("\n") == 1, "an error is one line"
    names.register("/rpc/dead", "tcp", "127.0.0.1", 1)
    assert here("rpc", "/rpc/dead").code == 1


def test_a_target_that_comes_back(cli, names):
    def port():
        return yarpy.RpcServer("/rpc/moody", lambda message: ["ok"], names=names)

    first = port()
    with cli.start("rpc", "/rpc/moody") as process:
        process.write_line("one")
        process.wait_line("Response: ok", stream="out")
        first.close()
        process.write_line("two")
        process.wait_line("Target disappeared, reconnecting", stream="err")
        with port():
            process.wait_line("Response: ok", count=2, stream="out")
        process.write_line("three")
        assert process.wait() == 1
    assert 'error: "/rpc/moody" went away' in process.stderr


def test_as_a_client_with_a_port(cli, server_port, names):
    with cli.start("rpc", "--client", "/rpc/client") as process:
        process.write_line("x")
        process.wait_line("active", stream="err")
        assert cli.run("connect", "/rpc/client", "/rpc/server").returncode == 0
        process.wait_line(r"^\[ok\] echo \(x\)$", stream="out")
        process.write_line("list")
        process.wait_line("^  two words$", stream="out")
        process.end_input()
        assert process.wait() == 0
    assert process.stdout == "[ok] echo (x)\n  a 1\n  two words\n"
    assert server_port.sources[-1] == "/rpc/client"
    assert names.query("/rpc/client") is None


def test_as_a_client_connected_at_once(cli, server_port):
    said = cli.run("rpc", "--client", "/rpc/client", "/rpc/server", input="x\n")
    assert (said.returncode, said.stdout) == (0, "[ok] echo (x)\n")


def test_completion_knows_the_commands_of_the_target(here, server_port):
    target = Target("/rpc/server")
    assert commands_of(target.ask) == ["home", "help", "stop"]
    target.close()


@pytest.mark.parametrize(
    "reply",
    ['"no idea"', "", "[fail]", "[many] a b", '[many] "Commands:" a', "(x y)"],
)
def test_no_completion_from_other_replies(reply):
    assert commands_of(lambda question: yarpy.Bottle.from_text(reply)) == []


@pytest.mark.parametrize(
    "reply",
    ['[many] "*** Available commands:" a b', '("*** Available commands:" a b)',
     '"*** Available commands:" a b', '[many] ("*** Available commands:" a b)'],
)  # fmt: skip
def test_spellings_of_a_list_of_commands(reply):
    assert commands_of(lambda question: yarpy.Bottle.from_text(reply)) == ["a", "b"]


@pytest.mark.parametrize(
    ("reply", "items"),
    [
        ("[many]", []),
        ("[many] a (b c)", ["a", ["b", "c"]]),
        ("[many] (b c)", ["b", "c"]),
        ("many a", None),
        ("", None),
        ("[ok] x", None),
    ],
)
def test_many(reply, items):
    assert many(yarpy.Bottle.from_text(reply)) == items


def test_empty_reply(capsys):
    print_reply(yarpy.Bottle())
    assert capsys.readouterr().out == "Response: \n"


def test_a_port_that_answers_nobody(cli, names):
    with yarpy.Port("/rpc/writer", callback=lambda message: None, names=names):
        said = cli.run("rpc", "/rpc/writer", input="one\ntwo\n")
    assert said.stdout == "Response: \nResponse: \n"
    assert said.stderr.count('warning: the answer is empty: "/rpc/writer" has nothing to say') == 1


def test_nothing_is_asked_of_another_port(cli, names, server_port):
    """One that has the number by now which the name server remembers of a port that is gone."""
    names.register("/rpc/gone", "tcp", "127.0.0.1", server_port.contact.port)
    assert cli.run("rpc", "/rpc/gone", input="an alias, made by hand").returncode == 0
    names.set("/rpc/gone", "process", 1)  # as ports say of themselves
    asked = len(server_port.sources)
    for words in (["rpc"], ["admin", "rpc"]):
        said = cli.run(*words, "/rpc/gone", input="[ver]\n")
        assert (said.returncode, said.stdout) == (1, "")
        assert '"/rpc/server" listens' in said.stderr and 'not "/rpc/gone"' in said.stderr
    assert len(server_port.sources) == asked


def test_a_port_of_yarp_4_gets_its_spelling(here, names, monkeypatch):
    """It knows the commands of no older YARP and none of ours, by which it is known."""
    heard = []

    def answer(message):
        heard.append(is_yarp4(message.payload))
        return message.value

    with yarpy.RpcServer("/rpc/newer", answer, names=names):
        target = Target("/rpc/newer")
        assert target.ask(yarpy.Bottle(["f", 1.5, [2.5]])) == ["f", 1.5, [2.5]]
        target.close()
        administer_as_yarp4(monkeypatch)
        target = Target("/rpc/newer")
        assert target.ask(yarpy.Bottle(["f", 1.5, [2.5]])) == ["f", 1.5, [2.5]]
        assert target.ask(yarpy.Bottle(["f", 1])) == ["f", 1]
        target.close()
    assert heard == [False, True, None]


def test_what_a_service_of_ros2_cannot_take_is_said(monkeypatch):
    pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')
    with ros2_router() as number:
        monkeypatch.setenv("YARPY_ZENOH", f"127.0.0.1:{number}")
        target = Target("ros2://nobody~std_srvs/srv/SetBool")
        with pytest.raises(yarpy.DecodeError, match=r"expected 1 elements \(data\), got 2$"):
            target.ask([1, 2])
        assert str(target.ask([1])[1]).startswith("nobody serves /nobody")  # and it goes on
        target.close()
