"""The interface of YARP 4's control board: what is written in Python is what the file says."""

from pathlib import Path

from yarpy.kits.devices.control_board.yarp4 import functions
from yarpy.kits.thrift.interface import read_interface
from yarpy.kits.thrift.module import python

FILE = Path(functions.__file__).with_suffix(".thrift")


def test_the_module_is_written_from_the_file() -> None:
    assert Path(functions.__file__).read_text(encoding="utf-8") == python(read_interface(FILE))


def test_names_are_sent_as_they_are() -> None:
    methods = functions.ControlBoardMsgs._methods
    assert len(methods) == 193
    assert all(name.endswith("RPC") and "_" not in name for name in methods)
    assert methods["getAxesRPC"].head == bytes.fromhex("00010000 01000000 04000000 0a000000") + (
        b"getAxesRPC"
    )
