"""What the decorator keeps of Wrapyfi, what it repairs, and what it says louder."""

from __future__ import annotations

import functools
import gc
import json
import logging
import pickle
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarpy

pytest.importorskip("zmq")

import wrapyfi
import wrapyfi.encoders
import wrapyfi.utils
from wrapyfi.connect.listeners import Listener, Listeners
from wrapyfi.connect.publishers import Publisher, Publishers
from wrapyfi.connect.wrapper import MiddlewareCommunicator
from wrapyfi.middlewares.zeromq import ZeroMQMiddlewarePubSub
from wrapyfi.utils.core_utils import Plugin, PluginRegistrar
from wrapyfi.utils.serialization_encoders import JsonDecodeHook, JsonEncoder

register = MiddlewareCommunicator.register
ROOT = Path(__file__).parents[2]
sent: list[tuple[str, Any]] = []


@Publishers.register("NativeObject", "here")
class HerePublisher(Publisher):
    """A middleware of a user's, which keeps everything in a list."""

    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        return self.check_establishment(True)

    def publish(self, obj: Any) -> None:
        sent.append((self.out_topic, obj))

    def close(self) -> None:
        sent.append((self.out_topic, "closed"))


@Listeners.register("NativeObject", "here")
class HereListener(Listener):
    def establish(self, repeats: int = -1, **kwargs: Any) -> bool:
        return self.check_establishment(True)

    def listen(self) -> Any:
        return self.in_topic

    def close(self) -> None:
        pass


class Two(MiddlewareCommunicator):
    @register("NativeObject", "here", "Two", "$topic")
    @register("NativeObject", "here", "Two", "/second")
    def give(self, number, topic="/first"):
        return f"{number} one", f"{number} two"


class Lists(MiddlewareCommunicator):
    @register([["NativeObject", "here", "L", "/a", {}], ["NativeObject", "here", "L", "/b", {}]])
    @register("NativeObject", "here", "L", "$1")
    def give(self, first, second="/c"):
        return ["x", "y"], "z"


@pytest.fixture(autouse=True)
def clean() -> Iterator[None]:
    sent.clear()
    yield
    MiddlewareCommunicator.close_all_instances()


def test_returns_stay_in_their_order_on_every_object() -> None:
    for number in range(3):  # also when one is closed and comes again
        one = Two()
        one.activate_communication(one.give, "publish")
        assert one.give(number) == (f"{number} one", f"{number} two")
        assert sent[-2:] == [("/first", f"{number} one"), ("/second", f"{number} two")]
        if number == 1:
            one.close()


def test_arguments_of_the_first_call_count_for_topics() -> None:
    one = Two()
    one.activate_communication("give", "publish")
    one.give(1, "/other")  # by its place, too
    one.give(2, topic="/third")
    assert [topic for topic, _ in sent] == ["/other", "/second"] * 2


def test_lists_in_one_return() -> None:
    one = Lists()
    one.activate_communication(one.give, "publish")
    one.give("first", "/c")
    assert sent == [("/a", "x"), ("/b", "y"), ("/c", "z")]
    one.activate_communication(one.give, "listen")
    assert one.give("first", "/d") == [["/a", "/b"], "/d"]


def test_modes() -> None:
    one = Two()
    assert one.give(1) == ("1 one", "1 two")
    for mode in (None, "none"):
        one.activate_communication(one.give, mode)
        assert one.give(1) == ("1 one", "1 two") and sent == []
    one.activate_communication(one.give, "disable")
    assert one.give(1) == [None, None]
    with pytest.raises(ValueError, match='no mode "fly": take publish'):
        one.activate_communication(one.give, "fly")
    with pytest.raises(AttributeError):
        one.activate_communication("nothing", "publish")
    one.activate_communication(Two.__init__, "publish")  # not decorated: silently nothing
    one.activate_communication(one.give, "publish")
    one.give(1)
    one.close()
    assert ("/first", "closed") in sent and one.give(2) == ("2 one", "2 two")


def test_object_that_is_gone_takes_part_no_more() -> None:
    one, other = Two(), Two()
    one.activate_communication(one.give, "publish")
    other.activate_communication(other.give, "listen")
    one.give(1)
    del one
    gc.collect()
    wait_until(lambda: ("/first", "closed") in sent)
    registry = MiddlewareCommunicator._MiddlewareCommunicator__registry  # type: ignore[attr-defined]
    wait_until(lambda: "Two.give.2" not in registry)
    assert registry["Two.give"]["mode"] == "listen"


def test_other_decorators_do_not_matter() -> None:
    def logged(func: Any) -> Any:
        @functools.wraps(func)
        def call(*args: Any, **kwargs: Any) -> Any:
            return func(*args, **kwargs)

        return call

    class Mixed(MiddlewareCommunicator):
        @logged
        @register("NativeObject", "here", "Mixed", "/mixed")
        @logged
        def give(self):
            return (1,)

    one = Mixed()
    one.activate_communication(one.give, "publish")
    one.give()
    assert sent == [("/mixed", 1)]


def test_middleware_that_is_not_there_says_why(caplog: pytest.LogCaptureFixture) -> None:
    class Lost(MiddlewareCommunicator):
        @register("NativeObject", "pigeons", "Lost", "/lost")
        @register("NativeObject", "$mware", "Lost", "/off")
        def give(self, mware=None):
            return 1, 2

    one = Lost()
    one.activate_communication(one.give, "publish")
    with caplog.at_level(logging.WARNING):
        assert one.give() == (1, 2)
    assert "no publisher for NativeObject over pigeons" in caplog.text
    assert "None" not in caplog.text and sent == []
    one.activate_communication(one.give, "listen")
    assert one.give() == [None, None]


def test_what_wrapyfi_does_not_have_says_so(caplog: pytest.LogCaptureFixture) -> None:
    pytest.importorskip("zenoh")

    class Lost(MiddlewareCommunicator):
        @register("NativeObject", "zenoh", "Lost", "/lost")
        def give(self):
            return 1

    one = Lost()
    one.activate_communication(one.give, "request")
    with caplog.at_level(logging.WARNING):
        one.give()
    assert "over zenoh (Wrapyfi has no requests over it)" in caplog.text


def test_what_cannot_be_declared() -> None:
    with pytest.raises(NotImplementedError):
        register({"a": 1}, "here", "X", "/x")
    with pytest.raises(TypeError):
        register([["NativeObject", "here", "X", "/x"]])


def test_plug_ins() -> None:
    class Metres:
        def __init__(self, value: float) -> None:
            self.value = value

    @PluginRegistrar.register(types=Metres.__mro__[:-1])
    class MetresPlugin(Plugin):
        def __init__(self, load_unit: str = "m", **kwargs: Any) -> None:
            self.unit = load_unit

        def encode(self, obj: Any, *args: Any, **kwargs: Any) -> tuple[bool, dict[str, Any]]:
            return True, {"__wrapyfi__": ("MetresPlugin", obj.value)}

        def decode(self, kind: Any, whole: Any, *args: Any, **kwargs: Any) -> tuple[bool, Any]:
            return True, f"{whole[1]} {self.unit}"

    text = json.dumps({"a": [Metres(2.5), (1,)]}, cls=JsonEncoder)
    assert text == (
        '{"a": [{"__wrapyfi__": ["MetresPlugin", 2.5]}, {"__wrapyfi__": ["tuple", [1]]}]}'
    )
    hook = JsonDecodeHook(load_unit="km").object_hook
    assert json.loads(text, object_hook=hook) == {"a": ["2.5 km", (1,)]}


def test_pickles_are_refused() -> None:
    data = pickle.dumps([1], protocol=5).decode("latin-1")
    text = json.dumps({"__wrapyfi__": ["PandasData", data]})
    with pytest.raises(yarpy.DecodeError, match="runs code"):
        json.loads(text, object_hook=JsonDecodeHook().object_hook)


def test_names_of_0_4_and_0_5() -> None:
    assert wrapyfi.__version__ and wrapyfi.__url__ in wrapyfi.__doc__
    assert wrapyfi.encoders.JsonEncoder is JsonEncoder
    assert wrapyfi.utils.PluginRegistrar is PluginRegistrar
    assert {"yarp", "zeromq", "here"} <= MiddlewareCommunicator.get_communicators()
    assert ZeroMQMiddlewarePubSub() is ZeroMQMiddlewarePubSub.activate()
    from wrapyfi.utils.image_encoders import JpegEncoder

    assert JpegEncoder(quality=80).encode_jpg_image(np.zeros((8, 8, 3), "u1"))[:2] == b"\xff\xd8"


def test_import_runs_nothing_of_the_current_directory(tmp_path: Path) -> None:
    for folder in ("plugins", "publishers"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "evil.py").write_text("raise SystemExit(7)")
    code = f"""
import sys; sys.path.insert(0, {str(ROOT / "compat/wrapyfi/src")!r})
import logging, wrapyfi.connect.wrapper
print(logging.getLogger().level)
"""
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=HANG,
    )
    assert (done.returncode, done.stdout.strip()) == (0, "30"), done.stderr


def test_wheel_is_complete(tmp_path: Path) -> None:
    pytest.importorskip("hatchling", reason="the build backend comes with yarpy[test]")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel", "--quiet"]
    options = ["--no-deps", "--no-build-isolation", "--wheel-dir", str(tmp_path)]
    project = str(ROOT / "compat" / "wrapyfi")
    subprocess.run([*pip, *options, project], check=True, timeout=2 * HANG)
    names = zipfile.ZipFile(next(tmp_path.glob("*.whl"))).namelist()
    assert {"wrapyfi/__init__.py", "wrapyfi/connect/wrapper.py"} <= set(names)
    assert not [one for one in names if not one.startswith(("wrapyfi/", "yarpy_wrapyfi-"))]
