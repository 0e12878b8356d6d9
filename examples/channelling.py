"""Channelling: one method, several values, each to a topic and over a middleware of its own.

yarpy server
python examples/channelling.py publish
python examples/channelling.py listen          # what belongs together arrives together
yarpy view /robot/image                        # each topic is seen by itself, too
"""

import sys
import time
from typing import Annotated

import numpy as np

import yarpy
from yarpy.kits import wrap

Picture = Annotated[np.ndarray, wrap.Image("rgb")]


class Robot:
    @wrap.on("/robot/image", together=True, timeout=10)
    @wrap.on("/robot/sound", "websocket")
    @wrap.on("/robot/joints", encoding="frame")
    def sense(self, second: int = 0) -> tuple[Picture, yarpy.Sound, dict[str, float]]:
        image = np.full((48, 64, 3), second % 256, "u1")
        sound = np.sin(np.arange(1600) * (second + 1) / 50) * 20000
        return image, yarpy.Sound(sound.astype("i2")), {"elbow": second / 10}


if sys.argv[1:] not in (["publish"], ["listen"]):
    sys.exit(__doc__)
robot = Robot()
with getattr(wrap, sys.argv[1])(robot.sense):
    for number in range(600 if sys.argv[1] == "publish" else 3):
        image, sound, joints = robot.sense(number)
        print(image.shape, sound, joints, flush=True)
        time.sleep(0.1 if sys.argv[1] == "publish" else 0)
