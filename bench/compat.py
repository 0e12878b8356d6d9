"""`import yarp` of compat beside that of C++: pictures over foreign memory, and the import itself.

    python bench/compat.py [--seconds 3] [--rounds 3]

The same program runs under both: one process writes an ImageRgb of 1920 times 1080 pixels, set by
`setExternal`, as fast as it can, another reads. Pictures that were read count. The two take turns,
and the best round counts. (Small messages: `python bench/run.py --peers cpp compat`.)
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "tests"))

from support.cpp import CppYarp  # noqa: E402
from support.process import Process  # noqa: E402

READER = """
import sys, time, yarp
yarp.Network.init()
port = yarp.BufferedPortImageRgb()
port.setStrict(True)
assert port.open("/bench/video/in")
print("ready", flush=True)
port.read()
begin, count, seconds = time.time(), 0, float(sys.argv[1])
while time.time() - begin < seconds:
    image = port.read()
    count += 1
assert (image.width(), image.height()) == (1920, 1080)
print("pictures", count / (time.time() - begin), flush=True)
import os; os._exit(0)
"""
WRITER = """
import sys, yarp
yarp.Network.init()
port = yarp.Port()
assert port.open("/bench/video/out")
memory = bytearray(1920 * 1080 * 3)
image = yarp.ImageRgb()
image.setExternal(memoryview(memory), 1920, 1080)
assert yarp.Network.connect("/bench/video/out", "/bench/video/in", sys.argv[1])
while True:
    port.write(image)
"""
IMPORT = "import time; begin = time.perf_counter(); import yarp; print(time.perf_counter() - begin)"


def video(python: str, environment: dict[str, str], carrier: str, seconds: float) -> float:
    """Pictures a second."""
    reading = Process([python, "-c", READER, str(seconds)], env=environment)
    with reading as reader:
        reader.wait_line("ready")
        with Process([python, "-c", WRITER, carrier], env=environment):
            return float(reader.wait_line(r"pictures (\S+)", timeout=seconds + 20)[1])


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as home, CppYarp.prepare(Path(home)).server() as cpp:
        ours = {**os.environ, "YARP_CONFIG_HOME": cpp.environment["YARP_CONFIG_HOME"]}
        sides = {"C++": (str(cpp.interpreter), cpp.environment), "compat": (sys.executable, ours)}
        for carrier in ("tcp", "fast_tcp", ""):  # the last leaves the choice to each
            best = dict.fromkeys(sides, 0.0)
            for _ in range(options.rounds):
                for name, (python, environment) in sides.items():
                    found = video(python, environment, carrier, options.seconds)
                    best[name] = max(best[name], found)
            ratio = best["compat"] / best["C++"]
            figures = ", ".join(f"{name} {value:.0f}" for name, value in best.items())
            over = carrier or "its own choice"
            print(f"1080p over {over}, pictures a second: {figures} ({ratio:.2f} times)")
        for name, (python, environment) in sides.items():
            took = min(
                float(subprocess.check_output([python, "-c", IMPORT], env=environment))
                for _ in range(7)
            )
            print(f"import yarp, {name}: {took * 1000:.0f} ms")


if __name__ == "__main__":
    main()
