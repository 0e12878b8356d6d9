"""`yarpy repeat`."""

import signal

from support.wait import HANG

import yarpy


def test_sends_on_what_comes(cli, names):
    with (
        cli.start("repeat", "/repeat/a") as process,
        yarpy.Port("/repeat/source", names=names) as source,
        yarpy.Port("/repeat/sink", names=names) as sink,
    ):
        process.wait_line("active", stream="err")
        source.connect("/repeat/a")
        sink.listen_to("/repeat/a")
        for value in ([1, "x"], yarpy.Vector([1.0, 2.0]), "a scalar"):
            source.write(value, yarpy.Stamp(5, 1.5))
            message = sink.read(timeout=HANG)
            assert message.value == value
            assert message.stamp == yarpy.Stamp(5, 1.5)
            assert message.source == "/repeat/a"
        process.signal(signal.SIGINT)
        assert process.wait() == 130
    assert names.query("/repeat/a") is None
