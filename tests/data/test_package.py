import subprocess
import sys

import pytest

import yarpy.data


def test_every_name_is_there():
    for name in yarpy.data.__all__:
        assert getattr(yarpy.data, name).__name__ in (name, "Image")
        assert name in dir(yarpy.data)
    with pytest.raises(AttributeError, match="nothing"):
        yarpy.data.nothing  # noqa: B018


def test_nothing_is_loaded_before_its_time():
    program = (
        "import sys, yarpy.data\n"
        "assert not [name for name in sys.modules if name.startswith('yarpy.data.')]\n"
        "yarpy.data.Bottle([1]).to_bytes()\n"
        "yarpy.data.Vector([1.0]).to_wire()\n"
        "yarpy.data.Image\n"
        "assert 'numpy' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True, timeout=30)
