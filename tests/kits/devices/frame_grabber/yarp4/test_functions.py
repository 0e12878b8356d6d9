"""The interface of YARP 4's camera: what is written in Python is what the file says."""

from pathlib import Path

from yarpy.kits.devices.frame_grabber.yarp4 import functions
from yarpy.kits.thrift.interface import read_interface
from yarpy.kits.thrift.module import python


def test_the_module_is_written_from_the_file() -> None:
    file = Path(functions.__file__).with_suffix(".thrift")
    assert Path(functions.__file__).read_text(encoding="utf-8") == python(read_interface(file))
    assert len(functions.FrameGrabberMsgs._methods) == 54
