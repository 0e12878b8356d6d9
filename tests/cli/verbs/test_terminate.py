"""`yarpy terminate`."""

import yarpy


def test_asks_the_quit_port(cli, names):
    asked = []

    def quit_(message):
        asked.append((message.value, message.source))
        return [yarpy.Vocab("ok")]

    with yarpy.RpcServer("/terminate/device/quit", quit_, names=names):
        said = cli.run("terminate", "/terminate/device/quit")
        line = "Asking port /terminate/device/quit to quit gracefully\n"
        assert (said.returncode, said.stdout, said.stderr) == (0, line, "")
        said = cli.run("terminate", "/terminate/device")
        assert said.returncode == 0
    assert [value for value, _ in asked] == [["quit"], ["quit"]]


def test_who_cannot_be_asked(here, names):
    with yarpy.Port("/terminate/port", names=names):
        said = here("terminate", "/terminate/port")
        assert (said.code, said.out) == (1, "")
        assert '"/terminate/port" has no port "/terminate/port/quit"' in said.err
    said = here("terminate", "/nobody")
    assert said.code == 1 and 'no port "/nobody" is registered' in said.err
