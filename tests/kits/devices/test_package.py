import subprocess
import sys

import pytest

import yarpy.kits.devices


def test_every_name_is_there():
    for name in yarpy.devices.__all__:
        assert getattr(yarpy.devices, name) is not None
        assert name in dir(yarpy.devices)
    with pytest.raises(AttributeError, match="nothing"):
        yarpy.devices.nothing  # noqa: B018


def test_nothing_is_loaded_before_its_time():
    program = (
        "import sys, yarpy\n"
        "assert not [name for name in sys.modules if name.startswith('yarpy.kits.devices')]\n"
        "yarpy.devices.ControlBoardServer, yarpy.devices.ControlBoard\n"
        "yarpy.devices.MultiSensorServer, yarpy.devices.FrameGrabberServer\n"
        "assert 'numpy' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=30)
