"""Images: a numpy array goes out as it is, and comes in as a view of the received bytes.

    python examples/images.py

Needs no name server. The same messages go to and come from yarpview and C++ programs.
"""

import numpy as np

import yarpy


def picture(number: int) -> np.ndarray:
    """A 240 x 320 colour picture with a bright square that moves."""
    pixels = np.zeros((240, 320, 3), "uint8")
    pixels[100:140, 10 * number : 10 * number + 40] = (255, 200, 0)
    return pixels


def main() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/eye", names=names) as eye,
        yarpy.BufferedPort("/brain", strict=True, names=names) as brain,
    ):
        eye.connect("/brain")
        for number in range(3):
            eye.write(picture(number), yarpy.Stamp(number, number / 30))
            message = brain.read(timeout=5)
            image = message.value  # a yarpy.Image
            pixels = image.array  # a view: nothing was copied
            middle = np.argwhere(pixels[..., 0]).mean(axis=0).round(1)
            print(f"{image} at {message.stamp.time:.3f} s, {pixels.shape}, square at {middle}")
            assert not pixels.flags.owndata

        # Other pixels need their code; rows may be padded, as in C++.
        depth = np.full((2, 5), 1.5, "float32")
        eye.write(yarpy.Image(depth))
        print(brain.read(timeout=5).value)
        eye.write(yarpy.Image(picture(0), "bgr", quantum=1))
        print(brain.read(timeout=5).value.converted("mono"))


if __name__ == "__main__":
    main()
