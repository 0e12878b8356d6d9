"""The functions of YARP 4's camera: what is declared in Python is what the file says."""

from support.declared import assert_as_the_file_says

from yarpy.kits.devices.frame_grabber.yarp4 import functions


def test_they_are_what_the_file_says() -> None:
    assert_as_the_file_says(functions)
