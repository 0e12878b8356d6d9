"""The interface of YARP 4's control board: what is declared in Python is what the file says."""

from support.declared import assert_as_the_file_says

from yarpy.kits.devices.control_board.yarp4 import functions


def test_they_are_what_the_file_says() -> None:
    assert_as_the_file_says(functions)


def test_names_are_sent_as_they_are() -> None:
    methods = functions.ControlBoardMsgs._methods
    assert len(methods) == 193
    assert all(name.endswith("RPC") and "_" not in name for name in methods)
    assert methods["getAxesRPC"].head == bytes.fromhex("00010000 01000000 04000000 0a000000") + (
        b"getAxesRPC"
    )
