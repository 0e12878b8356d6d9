"""What Python programs send: arrays of every type, and a dict of them, beside an Image.

Each value goes to a second program and back, over tcp, `write(value)` ... `read().value` on both
sides. The last column is its time divided by that of an Image of as many bytes: the two take turns,
so that what else the machine does meets both; medians of a round, and the median of the rounds.
"pickle" and "msgpack" carry the same dict as bytes that the programs pack and unpack.

    python bench/values.py [--bytes 1000000] [--rounds 5] [--count 30]
"""

import argparse
import os
import pickle
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import yarpy

try:
    import msgpack
except ImportError:  # `pip install -e '.[bench]'`
    msgpack = None

ECHO = """
import sys
sys.path.insert(0, sys.argv[1])
import values, yarpy
into, out = yarpy.Port("/values/echo/in"), yarpy.Port("/values/echo/out")
out.connect("/values/in", "tcp")
print("open", flush=True)
while True:
    message = into.read()
    unpack, pack = values.FORMS[message.envelope]
    out.write(pack(unpack(message)), message.envelope)
"""
TYPES = ["f8", "f4", "f2", "i8", "i4", "i2", "i1", "u8", "u4", "u2", "u1", "?", "c16", "c8"]


def _msgpack_default(value: Any) -> Any:
    return {"dtype": value.dtype.str, "shape": value.shape, "data": value.tobytes()}


def _msgpack_hook(found: dict[str, Any]) -> Any:
    if "dtype" not in found:
        return found
    return np.frombuffer(found["data"], found["dtype"]).reshape(found["shape"])


def _to_msgpack(value: Any) -> bytes:
    return msgpack.packb(value, default=_msgpack_default)


def _of_msgpack(message: yarpy.Message) -> Any:
    return msgpack.unpackb(message.as_(bytes), object_hook=_msgpack_hook, max_bin_len=1 << 30)


#: envelope -> how a message becomes a value, and a value what is written
FORMS: dict[str, tuple[Callable[[yarpy.Message], Any], Callable[[Any], Any]]] = {
    "value": (lambda message: message.value, lambda value: value),
    "pickle": (lambda message: pickle.loads(message.as_(bytes)), lambda it: pickle.dumps(it, 5)),
    "msgpack": (_of_msgpack, _to_msgpack),
}


def cases(size: int) -> list[tuple[str, str, Any, int]]:
    """Title, form, value, and the bytes of its arrays."""
    side = int(size**0.5) // 8 * 8
    found: list[tuple[str, str, Any, int]] = [("bytes", "value", bytes(size), size)]
    for name in TYPES:
        dtype = np.dtype(name)
        flat = np.ones(size // dtype.itemsize, dtype)
        for shape in ((flat.size,), (flat.size // 1000, 1000), (flat.size // 500, 100, 5)):
            array = flat[: int(np.prod(shape))].reshape(shape)
            found.append((f"{dtype.name} {array.ndim}-D", "value", array, array.nbytes))
    observation = {
        "rgb": np.ones((side // 3, side, 3), "uint8"),
        "joints": np.arange(32.0),
        "task": "pick",
    }
    held = side // 3 * side * 3 + 256
    nested = {"cameras": {"left": observation, "right": None}, "step": 7}
    for form in FORMS if msgpack is not None else ("value", "pickle"):
        title = "dict of them" if form == "value" else f"the dict by {form}"
        found.append((title, form, observation, held))
    found.append(("dict of dicts", "value", nested, held))
    found.append(("list of them", "value", [observation["rgb"], 1.5, None], held))
    return found


class Pair:
    """Two ports of this program, around the program that gives everything back."""

    def __init__(self) -> None:
        self.into = yarpy.Port("/values/in")
        self.out = yarpy.Port("/values/out")
        here = os.path.dirname(os.path.abspath(__file__))
        command = [sys.executable, "-c", ECHO, here]
        self.program = subprocess.Popen(command, stdout=subprocess.PIPE)
        assert self.program.stdout is not None
        self.program.stdout.readline()
        self.out.connect("/values/echo/in", "tcp")

    def there_and_back(self, value: Any, form: str) -> float:
        """Return the seconds that it takes."""
        unpack, pack = FORMS[form]
        start = time.perf_counter()
        self.out.write(pack(value), form)
        unpack(self.into.read(60))
        return time.perf_counter() - start

    def close(self) -> None:
        self.program.kill()
        self.program.communicate()
        self.out.close()
        self.into.close()


def measure(size: int, rounds: int, count: int) -> dict[str, list[tuple[float, float]]]:
    """Of each case, seconds and the ratio to an Image of the same bytes, of every round."""
    found: dict[str, list[tuple[float, float]]] = {}
    with yarpy.NameServer() as names:
        os.environ.update(names.environment)
        pair = Pair()
        try:
            for _ in range(rounds):
                for title, form, value, held in cases(size):
                    image = yarpy.Image(np.ones((held // 1000 or 1, 1000), "uint8"))
                    took, its = [], []
                    for _ in range(count):  # in turns
                        its.append(pair.there_and_back(image, "value"))
                        took.append(pair.there_and_back(value, form))
                    typical, beside = statistics.median(took), statistics.median(its)
                    found.setdefault("Image", []).append((beside, 1.0))
                    found.setdefault(title, []).append((typical, typical / beside))
        finally:
            pair.close()
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bytes", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--count", type=int, default=30)
    options = parser.parse_args()
    print(f"{options.bytes} bytes, there and back; load {os.getloadavg()[0]:.1f}")
    print("| value | us | times an Image |")
    print("|---|--:|--:|")
    for title, rounds in measure(options.bytes, options.rounds, options.count).items():
        took, ratio = (statistics.median(values) for values in zip(*rounds, strict=True))
        print(f"| {title} | {took * 1e6:.0f} | {ratio:.2f} |")
    if msgpack is None:
        print("msgpack is not installed: pip install -e '.[bench]'")


if __name__ == "__main__":
    main()
