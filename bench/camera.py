"""A camera to several programs: how many of its pictures arrive, and what each costs.

One program writes pictures at a rate, as a camera comes; the readers are programs of their own that
take the newest one and look at some of its pixels. "prepared": the camera fills memory that
`port.prepare` gives. The carriers take turns.

    python bench/camera.py [--rate 60] [--readers 3] [--seconds 5] [--rounds 3] [--size 3840x2160]
"""

import argparse
import os
import statistics
import subprocess
import sys
import time

import numpy as np

import yarpy

PREPARED = "memory, prepared"
CARRIERS = (PREPARED, "memory", "tcp")
READER = """
import sys, yarpy
port = yarpy.BufferedPort(sys.argv[1])
print("open", flush=True)
for message in port:
    array = message.as_(yarpy.Image).array
    array[::64, ::64].sum()
    del array, message
"""


def watch(carrier: str, options: argparse.Namespace) -> tuple[float, float]:
    """Pictures per second that each reader gets, and milliseconds of processor time for each
    picture and reader, of all programs together."""
    width, height = map(int, options.size.split("x"))
    picture = np.zeros((height, width, 3), np.uint8)
    names = [f"/camera/view{number}" for number in range(options.readers)]
    programs = [
        subprocess.Popen([sys.executable, "-c", READER, name], stdout=subprocess.PIPE, text=True)
        for name in names
    ]
    try:
        with yarpy.Port("/camera/out") as out:
            for program, name in zip(programs, names, strict=True):
                assert program.stdout is not None
                program.stdout.readline()
                out.connect(name, carrier.partition(",")[0])

            def shoot() -> None:
                """Write a picture, which the camera puts where it is to be."""
                taken = out.prepare(picture.shape) if carrier == PREPARED else picture
                taken[::32, ::32] = count % 256
                out.write(taken)

            count = 0
            for _ in range(5):
                shoot()
            before = sum(map(_used, ["self", *(program.pid for program in programs)]))
            start = due = time.perf_counter()
            while time.perf_counter() - start < options.seconds:
                shoot()
                count += 1
                due += 1 / options.rate
                time.sleep(max(0.0, due - time.perf_counter()))
            out.flush()
            took = time.perf_counter() - start
            after = sum(map(_used, ["self", *(program.pid for program in programs)]))
    finally:
        for program in programs:
            program.kill()
            program.communicate()
    return count / took, (after - before) / count / options.readers / 1e6


def _used(process: object) -> float:
    """Nanoseconds of processor time of a program."""
    total = 0.0
    for thread in os.listdir(f"/proc/{process}/task"):
        with open(f"/proc/{process}/task/{thread}/schedstat", encoding="utf-8") as status:
            total += int(status.read().split()[0])
    return total


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rate", type=float, default=60.0)
    parser.add_argument("--readers", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--size", default="3840x2160")
    options = parser.parse_args()
    found: dict[str, list[tuple[float, float]]] = {carrier: [] for carrier in CARRIERS}
    with yarpy.NameServer() as names:
        os.environ.update(names.environment)
        for _ in range(options.rounds):
            for carrier, results in found.items():
                results.append(watch(carrier, options))
    print(f"{options.size} in colour, {options.rate:g} a second, {options.readers} readers")
    print("| carrier | pictures/s | processor time per picture and reader, ms |")
    print("|---|--:|--:|")
    for carrier, results in found.items():
        rate, cost = (statistics.median(values) for values in zip(*results, strict=True))
        print(f"| {carrier} | {rate:.1f} | {cost:.2f} |")


if __name__ == "__main__":
    main()
