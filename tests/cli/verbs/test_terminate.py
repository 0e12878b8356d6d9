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


def test_no_other_program_is_asked_to_end(here, names):
    """One that has the number by now which the name server remembers of a port that is gone."""
    asked = []
    with yarpy.RpcServer("/terminate/other", asked.append, names=names) as other:
        names.register("/terminate/gone/quit", "tcp", "127.0.0.1", other.contact.port)
        names.set("/terminate/gone/quit", "process", 1)  # as ports say of themselves
        said = here("terminate", "/terminate/gone")
        assert said.code == 1 and '"/terminate/other" listens' in said.err
    assert not asked
