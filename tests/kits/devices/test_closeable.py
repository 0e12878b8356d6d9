from contextlib import ExitStack

import pytest

from yarpy.kits.devices.closeable import Closeable, local_prefix, prefix


class Device(Closeable):
    def __init__(self, closed):
        self._resources = ExitStack()
        self._resources.callback(closed.append, 1)


def test_it_closes_once():
    closed = []
    with pytest.raises(ZeroDivisionError), Device(closed) as device:
        raise ZeroDivisionError
    device.close()
    assert closed == [1]


def test_names():
    assert prefix("robot/head/") == prefix("/robot/head") == "/robot/head"
    assert local_prefix("/me", "/robot/head") == local_prefix("me/", "/robot/head") == "/me"
    first, second = (local_prefix("", "/robot/head") for _ in range(2))
    assert first != second and first.startswith("/yarpy/") and first.endswith("/robot/head")
