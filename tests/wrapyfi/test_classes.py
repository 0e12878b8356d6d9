"""Classes as users of Wrapyfi write them, one for each way of use; they do what they did.

Rules: both sides are objects of one process, over YARP, with names of the process's own. A
publisher that waits for its listener runs in a thread.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.wait import HANG, wait_until

import yarpy

pytest.importorskip("zmq")

from wrapyfi.config.manager import ConfigManager
from wrapyfi.connect.wrapper import MiddlewareCommunicator
from wrapyfi.utils.core_utils import SingletonOptimized

register = MiddlewareCommunicator.register
pytestmark = pytest.mark.usefixtures("names")


@pytest.fixture(autouse=True)
def clean(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("WRAPYFI_TIMEOUT", str(HANG))
    yield
    MiddlewareCommunicator.close_all_instances()
    SingletonOptimized._instances.pop(ConfigManager, None)


@contextmanager
def again(act: Callable[[], Any]) -> Iterator[None]:
    """Call it again and again in a thread, as a program's loop does."""
    done = threading.Event()

    def run() -> None:
        while not done.wait(0.01):
            try:
                act()
            except yarpy.YarpError:
                return

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    yield
    done.set()


def heard(act: Callable[[], list[Any]]) -> list[Any]:
    """What a listener that does not wait gets in the end."""
    found: list[Any] = []

    def there() -> bool:
        found[:] = act()
        return bool(found) and all(one is not None for one in found)

    wait_until(there)
    return found


class Hello(MiddlewareCommunicator):
    """Every mode by one method."""

    @register("NativeObject", "$mware", "Hello", "/hello/word", carrier="tcp", should_wait=True)
    def send_message(self, arg_from_requester="", mware=None):
        return ({"message": "hello", "asked": arg_from_requester},)


def test_hello_publish_and_listen() -> None:
    here, there = Hello(), Hello()
    here.activate_communication(Hello.send_message, mode="publish")
    there.activate_communication("send_message", mode="listen")
    with again(lambda: here.send_message(mware="yarp")):
        assert there.send_message(mware="yarp") == [{"message": "hello", "asked": ""}]
        there.close()


def test_hello_request_and_reply() -> None:
    here, there = Hello(), Hello()
    here.activate_communication(here.send_message, mode="reply")
    there.activate_communication(there.send_message, mode="request")
    with again(lambda: here.send_message(mware="yarp")):
        found = there.send_message("me", mware="yarp")
        assert found == [{"message": "hello", "asked": "me"}]
        found = there.send_message(arg_from_requester="you", mware="yarp")
        assert found[0]["asked"] == "you"
        here.close()


class Mirror(MiddlewareCommunicator):
    """Mirroring: the arguments of the publisher count."""

    @register("NativeObject", "$mware", "Mirror", "/mirror/msg", should_wait="$blocking")
    def read_msg(self, mware=None, msg="", blocking=True):
        return ({"msg": msg},)


def test_mirroring() -> None:
    here, there = Mirror(), Mirror()
    here.activate_communication(here.read_msg, mode="publish")
    there.activate_communication(there.read_msg, mode="listen")
    with again(lambda: here.read_msg("yarp", "mine", blocking=False)):
        assert heard(lambda: there.read_msg(mware="yarp", msg="no", blocking=False)) == [
            {"msg": "mine"}
        ]


class Forward(MiddlewareCommunicator):
    """Forwarding: one link over multicast, the next over tcp; some modes are off."""

    @register("NativeObject", "$a", "Forward", "/forward/a", carrier="mcast", should_wait=True)
    def read_chain_a(self, a=None, msg=""):
        return (msg,)

    @register("NativeObject", "$b", "Forward", "/forward/b", carrier="tcp", should_wait=False)
    def read_chain_b(self, b=None, msg=""):
        return (msg,)


def test_forwarding() -> None:
    roles = [("publish", "disable"), ("listen", "publish"), ("disable", "listen")]
    first, middle, last = chain = [Forward() for _ in roles]
    for one, (a, b) in zip(chain, roles, strict=True):
        one.activate_communication(one.read_chain_a, mode=a)
        one.activate_communication(one.read_chain_b, mode=b)

    def hand_on() -> None:
        (found,) = middle.read_chain_a(a="yarp")
        middle.read_chain_b(b="yarp", msg=found)

    assert first.read_chain_b(b="yarp", msg="x") == [None]
    with again(lambda: first.read_chain_a(a="yarp", msg="word")), again(hand_on):
        assert heard(lambda: last.read_chain_b(b="yarp")) == ["word"]


class Channel(MiddlewareCommunicator):
    """Channelling: a value, a picture and a sound, each over its own middleware."""

    @register("NativeObject", "$a", "Channel", "/channel/native", should_wait=False)
    @register(
        "Image", "$b", "Channel", "/channel/image", width="$w", height="$h", should_wait=False
    )
    @register(
        "AudioChunk", "$c", "Channel", "/channel/sound", rate="$rate", chunk="$chunk",
        channels="$channels", should_wait=False,
    )  # fmt: skip
    def read(self, w=32, h=24, rate=16000, chunk=100, channels=2, a=None, b=None, c=None):
        img = np.full((h, w, 3), 5, np.uint8)
        aud = np.full((chunk, channels), 0.5, np.float32), rate
        return [img, aud], img, aud


def test_channelling() -> None:
    here, there = Channel(), Channel()
    here.activate_communication(here.read, mode="publish")
    there.activate_communication(there.read, mode="listen")
    with again(lambda: here.read(a="yarp", b="none", c="yarp")):

        def two() -> list[Any]:
            native, image, sound = there.read(a="yarp", b="none", c="yarp")
            assert image is None
            return [native, sound]

        native, (samples, rate) = heard(two)
    assert native[0].shape == (24, 32, 3) and native[1][1] == 16000
    assert samples.shape == (100, 2) and rate == 16000
    assert np.abs(samples - 0.5).max() < 1e-3


class Answers(MiddlewareCommunicator):
    """Requests whose replies are a value and a picture, or a value and a sound."""

    @register("NativeObject", "$mware", "Answers", "/answers/msg", persistent=True)
    @register("Image", "$mware", "Answers", "/answers/img", width="$w", height="$h", rgb=False)
    def image(self, msg=None, w=8, h=4, mware=None, *args, **kwargs):
        return {"msg": msg, "counter": kwargs["counter"]}, np.full((h, w), 7, np.uint8)

    @register("NativeObject", "$mware", "Answers", "/answers/msg2")
    @register("AudioChunk", "$mware", "Answers", "/answers/aud", rate="$rate", chunk=-1)
    def sound(self, msg=None, rate=-1, mware=None):
        return {"msg": msg}, (np.zeros(10, np.float32), 8000)


def test_request_and_reply_of_pictures_and_sounds() -> None:
    here, there = Answers(), Answers()
    for method in ("image", "sound"):
        here.activate_communication(method, mode="reply")
        there.activate_communication(method, mode="request")
    with again(lambda: here.image(mware="yarp", counter=0)):
        value, picture = there.image("x", counter=3, mware="yarp")
        assert value == {"msg": "x", "counter": 3} and picture.tolist() == [[7] * 8] * 4
        with again(lambda: here.sound(mware="yarp")):
            value, (samples, rate) = there.sound("y", mware="yarp")
            assert value == {"msg": "y"} and samples.shape == (10,) and rate == 8000
        here.close()


class Effects(MiddlewareCommunicator):
    """Two topics each way: one side sends and hears, the other one changes what comes."""

    @register(
        "Image", "$mware", "Effects", "/effects/unused", width="$w", height="$h",
        should_wait="$wait", multi_threaded=True, jpg={"quality": 80, "encoder": "opencv"},
        publisher_kwargs={"class_name": "Effects", "out_topic": "/effects/there"},
        listener_kwargs={"class_name": "Effects", "in_topic": "/effects/back"},
    )  # fmt: skip
    @register(
        "NativeObject", "$mware", "Effects", "/effects/unused2", should_wait="$wait",
        publisher_kwargs={"out_topic": "/effects/there2"},
        listener_kwargs={"in_topic": "/effects/back2"},
    )  # fmt: skip
    def send_image(self, w=32, h=24, wait=True, mware="yarp"):
        return np.full((h, w, 3), 100, np.uint8), {"effect": "none"}

    @register(
        "Image", "$mware", "Effects", "/effects/unused", should_wait=True, jpg=True,
        publisher_kwargs={"out_topic": "/effects/back"},
        listener_kwargs={"in_topic": "/effects/there"},
    )  # fmt: skip
    @register(
        "NativeObject", "$mware", "Effects", "/effects/unused2", should_wait=True,
        publisher_kwargs={"out_topic": "/effects/back2"},
        listener_kwargs={"in_topic": "/effects/there2"},
    )  # fmt: skip
    def apply_effect(self, *data, effect_type="darker", mware="yarp"):
        image, _ = data
        return image // 2, {"effect": effect_type}


def test_transceive_and_reemit() -> None:
    here, there, other = Effects(), Effects(), Effects()
    other.activate_communication(other.apply_effect, mode=None)  # the second one must do it, too
    here.activate_communication(here.send_image, mode="transceive")
    there.activate_communication(there.apply_effect, mode="reemit")
    with again(lambda: there.apply_effect(effect_type="half")):
        image, said = here.send_image()
        assert image.shape == (24, 32, 3) and abs(int(image[0, 0, 0]) - 50) < 4
        assert said == {"effect": "half"}


def test_receive() -> None:
    here, there = Effects(), Effects()
    here.activate_communication(here.send_image, mode="publish")
    there.activate_communication(there.apply_effect, mode="receive")
    with again(here.send_image):
        image, said = there.apply_effect(effect_type="quiet")
        assert abs(int(image[0, 0, 0]) - 50) < 4 and said == {"effect": "quiet"}


class CamMic(MiddlewareCommunicator):
    """Sensors, called from threads of other libraries; the base class is not initialised."""

    def __init__(self) -> None:
        super(MiddlewareCommunicator, self).__init__()

    @register("Image", "$mware", "CamMic", "/cm/cam", width="$img_width", height="$img_height",
              rgb=True, fp=False, jpg=True, queue_size=10, should_wait=False)  # fmt: skip
    def collect_cam(self, img_width=32, img_height=24, mware="yarp"):
        return (np.full((img_height, img_width, 3), 9, np.uint8),)

    @register("AudioChunk", "$mware", "CamMic", "/cm/mic", rate="$mic_rate", chunk="$mic_chunk",
              channels="$mic_channels", should_wait=False)  # fmt: skip
    def collect_mic(self, aud=None, mic_rate=8000, mic_chunk=50, mic_channels=1, mware="yarp"):
        return (aud,)


def test_sensors() -> None:
    here, there = CamMic(), CamMic()
    for method in ("collect_cam", "collect_mic"):
        here.activate_communication(method, mode="publish")
        there.activate_communication(method, mode="listen")
    chunk = np.full((50, 1), 0.25, np.float32)
    with again(here.collect_cam), again(lambda: here.collect_mic(aud=(chunk, 8000))):
        # A listener's keyword that the method does not have is none of its business.
        (image,) = heard(lambda: there.collect_cam(img_source=0))
        assert image.shape == (24, 32, 3)
        ((samples, rate),) = heard(there.collect_mic)
        assert samples.shape == (50,) and rate == 8000


class Experiment(MiddlewareCommunicator):
    """Modes from files alone, one for each computer."""

    @register("NativeObject", "$_mware", "Experiment", "$_topic", should_wait=False)
    def forward(self, obj=None, _mware="yarp", _topic="/experiment/obj"):
        return (obj,)

    @register("NativeObject", "$_mware", "Experiment", "$_topic", should_wait=False)
    def listen(self, _mware="yarp", _topic="/experiment/obj"):
        return (None,)


def test_modes_from_files(tmp_path: Path) -> None:
    file = tmp_path / "COMP_main.yml"
    file.write_text("Experiment:\n  forward: [publish, null, disable]\n  listen: [null, listen]\n")
    ConfigManager(str(file))
    here, there, third = Experiment(), Experiment(), Experiment.__new__(Experiment)
    assert third.forward(obj=3) == (3,)  # one that was never activated
    with again(lambda: here.forward(obj={"a": 1})):
        assert heard(there.listen) == [{"a": 1}]
    assert here.listen() == (None,)


class Robot(MiddlewareCommunicator, yarpy.Module):
    """Listens to ports of a robot in C++, with another base class beside."""

    @register("Image", "yarp", "Robot", "$left_port", carrier="udp", width="$w", height="$h",
              rgb=True, should_wait=False)  # fmt: skip
    @register("Image", "yarp", "Robot", "$right_port", carrier="", width="$w", height="$h",
              rgb=True, should_wait=False)  # fmt: skip
    def receive_images(self, left_port, right_port, w=16, h=8):
        return None, None


def test_native_ports() -> None:
    robot = Robot()
    robot.activate_communication(robot.receive_images, mode="listen")
    with yarpy.Port("/icub/cam/left") as left, yarpy.Port("/icub/cam/right") as right:
        picture = yarpy.Image(np.full((8, 16, 3), (1, 2, 3), "u1"))

        def send() -> None:
            left.write(picture)
            right.write(picture)

        with again(send):
            ports = {"left_port": "/icub/cam/left", "right_port": "/icub/cam/right"}
            one, other = heard(lambda: robot.receive_images(**ports))
        assert one[0, 0].tolist() == other[0, 0].tolist() == [1, 2, 3]
        robot.close()


class Orientation(MiddlewareCommunicator):
    """Topics that are changed after the class was made."""

    @register("NativeObject", "$_mware", "Orientation", "$port", should_wait="$_should_wait")
    def transmit(self, angle=0.0, port="/orientation/none", _mware="none", _should_wait=False):
        return ({"angle": angle},)


def test_defaults_that_are_assigned() -> None:
    Orientation.transmit.__defaults__ = (0.0, "/orientation/here", "yarp", False)
    here, there = Orientation(), Orientation()
    here.activate_communication(here.transmit, mode="publish")
    there.activate_communication(there.transmit, mode="listen")
    with again(lambda: here.transmit(angle=3.5)):
        assert heard(there.transmit) == [{"angle": 3.5}]
    assert yarpy.exists("/orientation/here")


class Capture:
    """What stands for a class of OpenCV."""

    def __init__(self, source: int = 0) -> None:
        self.source = source

    def read(self) -> tuple[bool, Any]:
        return True, np.full((24, 32, 3), 77, np.uint8)


class VideoCapture(MiddlewareCommunicator, Capture):
    """A drop-in for it that publishes what it reads."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        MiddlewareCommunicator.__init__(self)
        Capture.__init__(self, *args)
        self.activate_communication(self.acquire_image, mode=kwargs.get("mode", "publish"))

    @register("Image", "$_mware", "VideoCapture", "$cap_feed_port", carrier="$cap_feed_carrier",
              width="$img_width", height="$img_height", rgb=True, jpg="$_jpg",
              should_wait="$_should_wait")  # fmt: skip
    def acquire_image(self, cap_feed_port="/capture/feed", cap_feed_carrier="tcp", img_width=32,
                      img_height=24, _jpg=False, _should_wait=False, _mware="yarp",
                      **kwargs):  # fmt: skip
        return (Capture.read(self)[1],)

    def read(self) -> tuple[bool, Any]:
        (image,) = self.acquire_image()
        return image is not None, image


class VideoCaptureReceiver(VideoCapture):
    """Subclassed once more: the method keeps its parent's name in the registry."""

    def __init__(self) -> None:
        super().__init__(mode="listen")


def test_drop_in_for_a_camera() -> None:
    camera, receiver = VideoCapture(0), VideoCaptureReceiver()
    with again(camera.read):
        wait_until(lambda: receiver.read()[0])
    registry = MiddlewareCommunicator._MiddlewareCommunicator__registry  # type: ignore[attr-defined]
    assert "VideoCapture.acquire_image.2" in registry
    assert not any("VideoCaptureReceiver" in key for key in registry)


class Block(MiddlewareCommunicator):
    """Many objects of one method, each with a topic and a mode of its own, as parts of networks."""

    @register("NativeObject", "yarp", "Block", "$topic_name", should_wait=False,
              listener_kwargs={"load_torch_device": "$device"})  # fmt: skip
    def forward(self, x, topic_name="/block", device="cuda:0"):
        return (x + 1,)


def test_many_objects_of_one_method() -> None:
    count = 12
    sending, taking = ([Block() for _ in range(count)] for _ in range(2))
    for one, other in zip(sending, taking, strict=True):
        one.activate_communication(one.forward, mode="publish")
        other.activate_communication(other.forward, mode="listen")
    x = np.arange(3.0)

    def act() -> None:
        for number, block in enumerate(sending):
            block.forward(x * number, topic_name=f"/block/{number}")

    with again(act):
        for number, block in enumerate(taking):
            (found,) = heard(lambda n=number, b=block: b.forward(None, topic_name=f"/block/{n}"))
            assert found.tolist() == (x * number + 1).tolist()
    assert Block().forward(1.0) == (2.0,)
