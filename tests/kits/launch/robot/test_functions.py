"""The functions of a robot's port, as they are written from their file."""

from pathlib import Path

import pytest

from yarpy.kits.launch.robot import functions

pytest.importorskip("lark", reason="install yarpy[idl]: it reads .thrift files")


def test_they_are_what_the_file_says() -> None:
    from yarpy.kits.thrift.interface import read_interface
    from yarpy.kits.thrift.module import python

    path = Path(functions.__file__)
    assert path.read_text(encoding="utf-8") == python(read_interface(path.with_suffix(".thrift")))
