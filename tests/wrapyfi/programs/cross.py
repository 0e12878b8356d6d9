"""Each type of Wrapyfi, sent or taken: `cross.py SIDE MIDDLEWARE,... TYPE...`, by either `wrapyfi`.

A sender sends until its input ends. A taker prints a line of JSON for each type and middleware, and
ends.
"""

import importlib
import json
import os
import sys
import threading
import time

import numpy as np

from wrapyfi.connect.wrapper import MiddlewareCommunicator

side = sys.argv[1]
mwares = sys.argv[2].split(",")
types = sys.argv[3:]
TOPICS = os.environ.get("CROSS_TOPICS", "/x")
# Wrapyfi's publishers over ZeroMQ may never see that somebody listens, while others send.
WAIT = os.environ.get("CROSS_WAIT") != "0"
COLOUR = np.arange(24 * 32 * 3, dtype=np.uint8).reshape(24, 32, 3)
PLAIN = np.full((24, 32, 3), (200, 10, 20), dtype=np.uint8)
SOUND = np.sin(np.arange(200) / 10).astype(np.float32)


class Cross(MiddlewareCommunicator):
    @MiddlewareCommunicator.register(
        "NativeObject", "$mware", "Cross", f"{TOPICS}/native", should_wait=WAIT
    )
    def native(self, mware=None):
        return ({"t": (1, 2), "s": {1, None}, "a": np.arange(4.0), "n": [None, True, 2.5]},)

    @MiddlewareCommunicator.register(
        "Image", "$mware", "Cross", f"{TOPICS}/rgb", width=32, height=24, rgb=True, should_wait=WAIT
    )
    def rgb(self, mware=None):
        return (COLOUR,)

    @MiddlewareCommunicator.register(
        "Image",
        "$mware",
        "Cross",
        f"{TOPICS}/mono",
        width=32,
        height=24,
        rgb=False,
        should_wait=WAIT,
    )
    def mono(self, mware=None):
        return (COLOUR[..., 0],)

    @MiddlewareCommunicator.register(
        "Image",
        "$mware",
        "Cross",
        f"{TOPICS}/fp",
        width=32,
        height=24,
        rgb=True,
        fp=True,
        should_wait=WAIT,
    )
    def fp(self, mware=None):
        return (COLOUR.astype(np.float32) / 7,)

    @MiddlewareCommunicator.register(
        "Image",
        "$mware",
        "Cross",
        f"{TOPICS}/jpg",
        width=32,
        height=24,
        rgb=True,
        jpg=True,
        should_wait=WAIT,
    )
    def jpg(self, mware=None):
        return (PLAIN,)

    @MiddlewareCommunicator.register(
        "AudioChunk",
        "$mware",
        "Cross",
        f"{TOPICS}/sound",
        rate=16000,
        chunk=200,
        channels=1,
        should_wait=WAIT,
    )
    def sound(self, mware=None):
        return ((SOUND, 16000),)

    @MiddlewareCommunicator.register(
        "ROSMessage", "$mware", "Cross", f"{TOPICS}/pose", should_wait=WAIT
    )
    def pose(self, mware=None):
        pose = message("geometry_msgs", "Pose")()
        pose.position.x = 0.5
        return (pose,)

    @MiddlewareCommunicator.register("Properties", "$mware", "Cross", f"{TOPICS}/property")
    def property(self, mware=None):
        return ({"a": [1, 2.5], "b": "word"},)

    @MiddlewareCommunicator.register(
        "Image", "$mware", "Cross", f"{TOPICS}/rpc_rgb", should_wait=WAIT
    )
    def ask_rgb(self, mware=None):
        return (COLOUR,)

    @MiddlewareCommunicator.register(
        "AudioChunk", "$mware", "Cross", f"{TOPICS}/rpc_sound", rate=16000, should_wait=WAIT
    )
    def ask_sound(self, mware=None):
        return ((SOUND, 16000),)

    @MiddlewareCommunicator.register(
        "NativeObject", "$mware", "Cross", f"{TOPICS}/rpc", should_wait=WAIT
    )
    def ask(self, *args, mware=None, **kwargs):
        return ({"args": list(args), "kwargs": kwargs},)


def message(package, name):
    """A class of rospy's, or of yarpy's."""
    try:
        return getattr(importlib.import_module(f"{package}.msg"), name)
    except ImportError:
        from yarpy.idl import load

        return load(f"{package}/{name}")


def told(name, value):
    """What came, as text that is the same for the same value."""
    if name == "pose":
        return [value.position.x, value.orientation.w, value._type]
    name = name.removeprefix("ask_")
    if name == "sound":
        samples, rate = value
        error = float(np.abs(np.ravel(samples) - SOUND).max())
        return {"rate": rate, "near": error < 1e-3}
    if name in ("rgb", "mono", "fp", "jpg"):
        array = np.asarray(value)
        expected = {"rgb": COLOUR, "mono": COLOUR[..., 0], "jpg": PLAIN}.get(name)
        expected = COLOUR.astype(np.float32) / 7 if expected is None else expected
        near = array.shape == expected.shape
        near = near and float(np.abs(array.astype(float) - expected).max()) < (
            9 if name == "jpg" else 1e-4
        )
        return {"shape": list(array.shape), "dtype": array.dtype.name, "near": bool(near)}
    return repr(value)


crosses = {mware: Cross() for mware in mwares}
for name in types:
    mode = {"send": "publish", "take": "listen"}[side]
    if name.startswith("ask"):
        mode = {"send": "reply", "take": "request"}[side]
    for cross in crosses.values():
        cross.activate_communication(name, mode)


def send(calls):
    while True:
        for mware, name in calls:
            getattr(crosses[mware], name)(mware=mware)
        time.sleep(0.05)


calls = [(mware, name) for mware in mwares for name in types]
if side == "send":
    print("ready", flush=True)
    for call in calls if WAIT else []:
        threading.Thread(target=send, args=([call],), daemon=True).start()
    if not WAIT:
        send(calls)
    sys.stdin.read()
else:
    for mware, name in calls:
        if name == "ask":
            (value,) = crosses[mware].ask((1, 2), [3], k={"z": (9,)}, mware=mware)
        else:
            value = None
            while value is None or (name == "sound" and value[0] is None):
                (value,) = getattr(crosses[mware], name)(mware=mware)
        print(json.dumps([mware, name, told(name, value)]), flush=True)
os._exit(0)
