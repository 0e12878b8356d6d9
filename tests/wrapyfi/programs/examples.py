"""Examples that Wrapyfi's package brings, as they are, in one process: `examples.py FOLDER [ros]`.

Each role of each example runs in a thread, as a program of its own would. What they print is
printed behind the role's name. Camera, microphone, loudspeaker, windows and keyboard are stand-ins.
It runs until it is ended.
"""

import argparse
import builtins
import runpy
import sys
import threading
import time
import types

import cv2
import numpy as np

import yarpy
from yarpy.names.default import DEFAULT

folder = sys.argv[1]
DEFAULT.push(yarpy.LocalNames())
PATTERNS, SCHEMES = "communication_patterns", "communication_schemes"
CHAIN = ["--mware_chain_A", "zeromq", "--mware_chain_B", "yarp"]
CHANNELS = ["--mware_A", "zeromq", "--mware_B", "yarp", "--mware_C", "yarp"]
EFFECTS = ["--mware", "yarp", "--should_wait", "--img_width", "32", "--img_height", "24"]
SENSORS = ["--mware", "yarp", "--img_width", "32", "--img_height", "24", "--mic_chunk", "80"]
ROLES = {
    "hello publish": ("hello_world", ["--publish", "--mware", "zeromq"]),
    "hello listen": ("hello_world", ["--listen", "--mware", "zeromq"]),
    "hello reply": ("hello_world", ["--reply", "--mware", "yarp"]),
    "hello request": ("hello_world", ["--request", "--mware", "yarp"]),
    "mirror publish": (f"{SCHEMES}/mirroring_example", ["--mode", "publish", "--mware", "yarp"]),
    "mirror listen": (f"{SCHEMES}/mirroring_example", ["--mode", "listen", "--mware", "yarp"]),
    "mirror reply": (f"{SCHEMES}/mirroring_example", ["--mode", "reply", "--mware", "zeromq"]),
    "mirror request": (f"{SCHEMES}/mirroring_example", ["--mode", "request", "--mware", "zeromq"]),
    "chain first": (
        f"{SCHEMES}/forwarding_example",
        [*CHAIN, "--mode_chain_A", "publish", "--mode_chain_B", "disable"],
    ),
    "chain middle": (
        f"{SCHEMES}/forwarding_example",
        [*CHAIN, "--mode_chain_A", "listen", "--mode_chain_B", "publish"],
    ),
    "chain last": (
        f"{SCHEMES}/forwarding_example",
        [*CHAIN, "--mode_chain_A", "disable", "--mode_chain_B", "listen"],
    ),
    "channel publish": (f"{SCHEMES}/channeling_example", ["--mode", "publish", *CHANNELS]),
    "channel listen": (f"{SCHEMES}/channeling_example", ["--mode", "listen", *CHANNELS]),
    "ask reply": (
        f"{PATTERNS}/request_reply_example",
        ["--mode", "reply", "--mware", "yarp", "--stream", "image"],
    ),
    "ask request": (
        f"{PATTERNS}/request_reply_example",
        ["--mode", "request", "--mware", "yarp", "--stream", "image"],
    ),
    "effects transceive": (f"{PATTERNS}/transceive_reemit_example", ["--transceive", *EFFECTS]),
    "effects reemit": (
        f"{PATTERNS}/transceive_reemit_example",
        ["--reemit", "--effect", "invert", *EFFECTS],
    ),
    "camera publish": ("sensors/cam_mic", ["--mode", "publish", "--stream", "video", *SENSORS]),
    "camera listen": ("sensors/cam_mic", ["--mode", "listen", "--stream", "video", *SENSORS]),
    "sound publish": ("sensors/cam_mic", ["--mode", "publish", "--stream", "audio", *SENSORS]),
    "sound listen": ("sensors/cam_mic", ["--mode", "listen", "--stream", "audio", *SENSORS]),
}
ROS_ROLES = {
    "message publish": ("custom_msgs/ros_message_example", ["--mode", "publish"]),
    "message listen": ("custom_msgs/ros_message_example", ["--mode", "listen"]),
    "property publish": ("custom_msgs/ros_parameter_example", ["--mode", "publish"]),
    "property listen": ("custom_msgs/ros_parameter_example", ["--mode", "listen"]),
}
if "ros" in sys.argv[2:]:
    ROLES = ROS_ROLES
write = sys.stdout.write


class Out:
    """Puts the role in front of each line."""

    def __init__(self) -> None:
        self.rest = threading.local()

    def write(self, text):
        *lines, rest = (getattr(self.rest, "text", "") + text).split("\n")
        self.rest.text = rest
        for line in lines:
            write(f"{threading.current_thread().name}: {line}\n")
            sys.__stdout__.flush()

    def flush(self):
        pass


class Camera:
    """Everything is bright."""

    def __init__(self, source):
        self.frame = np.full((24, 32, 3), 200, np.uint8)

    def set(self, option, value):
        pass

    def isOpened(self):  # noqa: N802  as OpenCV has it
        return True

    def read(self):
        time.sleep(0.02)
        return True, self.frame

    def release(self):
        pass


class Microphone:
    """Calls back for ever, as soon as it is used."""

    def __init__(self, callback, blocksize, channels, **options):
        self.callback, self.shape = callback, (blocksize, channels)

    def __enter__(self):
        while True:
            self.callback(np.full(self.shape, 0.25, np.float32), self.shape[0], None, None)
            time.sleep(0.02)

    def __exit__(self, *_):
        pass


def show(title, image):
    print(f"shown {image.shape} {int(image[0, 0, 0])}")


def play(samples, rate, **options):
    print(f"played {np.shape(samples)} {rate}")


def arguments(parser):
    return parser.parse_args_of(ROLES[threading.current_thread().name][1])


cv2.imread = lambda path: np.full((40, 40, 3), 100, np.uint8)
cv2.imshow, cv2.VideoCapture = show, Camera
cv2.waitKey = lambda pause: 255
cv2.getWindowProperty = lambda *what: 0
cv2.destroyAllWindows = lambda: None
sound = types.ModuleType("sounddevice")
sound.InputStream, sound.play, sound.wait = Microphone, play, lambda *_: None
sound.PortAudioError = OSError
files = types.ModuleType("soundfile")
files.read = lambda path, dtype: (np.zeros((80, 2), dtype), 8000)
stray = types.ModuleType("caffe2")  # one of them imports something that it does not use
stray.ret_string = stray.__path__ = ""
sys.modules |= {"sounddevice": sound, "soundfile": files}
sys.modules |= dict.fromkeys(
    ("caffe2", "caffe2.perfkernels", "caffe2.perfkernels.hp_emblookup_codegen"), stray
)
argparse.ArgumentParser.parse_args_of = argparse.ArgumentParser.parse_args
argparse.ArgumentParser.parse_args = arguments
builtins.input = lambda prompt: time.sleep(0.05) or "word"
sys.stdout = Out()
for role, (example, _) in ROLES.items():
    threading.Thread(
        target=runpy.run_path,
        args=(f"{folder}/{example}.py",),
        kwargs={"run_name": "__main__"},
        name=role,
        daemon=True,
    ).start()
threading.Event().wait()
