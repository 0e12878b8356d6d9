"""The functions of the battery: what is declared in Python is what the file says."""

from support.declared import assert_as_the_file_says

from yarpy.kits.devices.battery import functions


def test_they_are_what_the_file_says() -> None:
    assert_as_the_file_says(functions)
