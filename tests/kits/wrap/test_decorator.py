"""The decorator and what it leaves alone: other decorators, objects, classes, forks, the end."""

from __future__ import annotations

import functools
import gc
import os
import subprocess
import sys
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.decorator import target

pytestmark = pytest.mark.usefixtures("names")


def logged(func: Any) -> Any:
    @functools.wraps(func)
    def call(*args: Any, **kwargs: Any) -> Any:
        return func(*args, **kwargs)

    return call


class Arm:
    @wrap.on("/arm/a")
    def method(self) -> int:
        """What it says."""
        return 1

    @wrap.on("/arm/b")
    @staticmethod
    def static() -> int:
        return 2

    @classmethod
    @wrap.on("/arm/c")
    def of_class(cls) -> int:
        return 3

    @logged
    @wrap.on("/arm/d")
    @logged
    def between(self) -> int:
        return 4

    @wrap.on("/arm/e")
    @logged
    @wrap.on("/arm/f")
    def apart(self) -> tuple[int, int]:
        return 5, 6


class Hand(Arm):
    __slots__ = ()


class Slotted:
    __slots__ = ()

    @wrap.on("/arm/g")
    def method(self) -> int:
        return 7


@wrap.on("/arm/h")
def function() -> int:
    return 8


def test_names_and_words_are_kept() -> None:
    assert Arm.method.__name__ == "method" and Arm.method.__doc__ == "What it says."
    assert Arm.method.__wrapped__  # type: ignore[attr-defined]
    found = Arm().method(), Arm.static(), Arm.of_class(), Arm().between(), function()
    assert found == (1, 2, 3, 4, 8)


@pytest.mark.parametrize(
    ("decorated", "topic"),
    [
        (Arm().method, "/arm/a"),
        (Arm.static, "/arm/b"),
        (Arm.of_class, "/arm/c"),
        (function, "/arm/h"),
        (Arm().between, "/arm/d"),
        (Hand().method, "/arm/a"),
        (Slotted().method, "/arm/g"),
    ],
)
def test_everything_that_can_be_called(decorated: Any, topic: str) -> None:
    expected = decorated()
    with yarpy.BufferedPort("/reader") as reader, wrap.publish(decorated) as handle:
        yarpy.connect(topic, "/reader")
        assert decorated() == expected
        assert reader.read(timeout=HANG).value == expected
        assert handle.mode == "publish" and not handle.closed
    assert handle.closed and not yarpy.exists(topic)


def test_decorators_with_another_in_between() -> None:
    method, _ = target(Arm().apart)
    assert [output.topic for output in method.outputs] == ["/arm/e", "/arm/f"]


def test_mode_belongs_to_one_object() -> None:
    one, other = Arm(), Arm()
    with wrap.off(one.method):
        assert one.method() is None and other.method() == 1
        with wrap.off(other.method):
            assert other.method() is None
        assert other.method() == 1


def test_new_mode_ends_the_old_one() -> None:
    arm = Arm()
    first = wrap.publish(arm.method)
    second = wrap.off(arm.method)
    assert first.closed and arm.method() is None
    first.close()
    assert arm.method() is None
    second.close()
    assert arm.method() == 1
    assert repr(second) == "<Handle of Arm.method (closed)>"


def test_mode_ends_with_its_object() -> None:
    arm = Arm()
    wrap.publish(arm.method)
    assert yarpy.exists("/arm/a")
    del arm
    gc.collect()
    wait_until(lambda: not yarpy.exists("/arm/a"))
    assert not target(Arm.method)[0].active


def test_name_that_is_taken() -> None:
    with yarpy.Port("/arm/a"), pytest.raises(yarpy.AddressError):
        wrap.publish(Arm().method)
    assert Arm().method() == 1


def test_what_is_not_decorated() -> None:
    with pytest.raises(yarpy.LocalProtocolError, match=r"print is not decorated: write @wrap.on"):
        wrap.publish(print)
    with pytest.raises(TypeError, match="decorates functions"):
        wrap.on("/a")(3)
    with pytest.raises(ValueError, match="missing='maybe'"):
        wrap.on("/a", missing="maybe")  # type: ignore[arg-type]
    for name in ("timeout", "wait"):
        for seconds in (-1, float("nan")):
            with pytest.raises(ValueError, match=f"{name}={seconds}: a time to wait"):
                wrap.on("/a", **{name: seconds})
        with pytest.raises(TypeError, match=f"{name}='1' is no number"):
            wrap.on("/a", **{name: "1"})
    with pytest.raises(TypeError, match="qos=3 is no Qos"):
        wrap.on("/a", qos=3)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"wait of Arm.method is a matter of its decorator"):
        wrap.publish(Arm().method, wait=1)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r'no option "topc" of Arm.method: did you mean "topic"'):
        wrap.publish(Arm().method, topc="/a")  # type: ignore[call-arg]


def test_last_of_what_does_not_listen() -> None:
    assert wrap.last(Arm().method) is None
    assert wrap.last(Arm().apart) == (None, None)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
def test_forked_process_begins_without_modes() -> None:
    code = """
import os, yarpy
from yarpy import wrap
class Arm:
    @wrap.on("/arm")
    def method(self): return 1
with yarpy.NameServer() as server:
    arm = Arm()
    wrap.off(arm.method)
    child = os.fork()
    if not child:
        os._exit(0 if arm.method() == 1 else 1)
    print(os.waitpid(child, 0)[1], arm.method())
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=HANG
    )
    assert done.stdout.strip() == "0 None", done.stderr


def test_program_that_closes_nothing_gives_its_names_back() -> None:
    code = """
from yarpy import wrap
class Arm:
    @wrap.on("/arm")
    def method(self): return 1
arm = Arm()
wrap.publish(arm.method)
"""
    with yarpy.NameServer() as server:
        done = subprocess.run(
            [sys.executable, "-W", "error", "-c", code],
            capture_output=True, text=True, timeout=HANG,
            env={**os.environ, **server.environment},
        )  # fmt: skip
        assert (done.returncode, done.stderr) == (0, "")
        assert yarpy.query("/arm") is None
