"""What programs print, in the log of the network."""

import socket

import pytest
from support.wait import HANG

import yarpy
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.supervise.log_stream import LogStream, forwarding
from yarpy.port.keep.log_line import read_line


def test_lines_say_which_program_they_are_of(network: yarpy.LocalNames) -> None:
    application = Application("my app", modules=[Module("cam/left", "x"), Module("own", "y")])
    with yarpy.BufferedPort("/yarplogger", strict=True, names=network) as logger:
        stream = LogStream(application, network)
        try:
            stream.hear("cam/left", "[ERROR] no camera")
            stream.hear("own", "hello")
            lines = [read_line(logger.read(timeout=HANG).value) for _ in range(2)]
            names = [contact.name for contact in network.list()]
        finally:
            stream.close()
    host = socket.gethostname()
    assert [(one.origin.split("/")[3], one.level, one.text.strip()) for one in lines] == [
        ("cam_left", "ERROR", "no camera"),
        ("own", "", "hello"),
    ]
    assert any(name.startswith(f"/log/{host}/my_app/") for name in names)


def test_who_forwards_by_himself_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    own = Module("own", "x", environment={"YARP_FORWARD_LOG_ENABLE": "1"})
    application = Application("a", modules=[own, Module("other", "y")])
    monkeypatch.delenv("YARP_FORWARD_LOG_ENABLE", raising=False)
    assert forwarding(application) == {"own"}
    monkeypatch.setenv("YARP_FORWARD_LOG_ENABLE", "1")
    assert forwarding(application) == {"own", "other"}
