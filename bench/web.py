"""Measure a port as a web server:  python bench/web.py [--seconds 5]

    pictures      640 x 480 rgb as MJPEG, to one browser, and to four of the same quality
    requests      /?req=get+encs over connections that stay open, asked by wrk

The port runs on the first core, whoever asks on the second. Prints per second, and the processor
time of the port for each, which does not depend on what else the machine does.

Rules: no time is ever asserted; without wrk the requests are left out, and it is said.
"""

import argparse
import os
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

import yarpy

WIDTH, HEIGHT = 640, 480


def picture() -> yarpy.Image:
    """Something like what a camera sees: smooth areas, edges, a little noise."""
    y, x = np.mgrid[:HEIGHT, :WIDTH]
    pixels = np.stack([x / 4, y / 3, (x + y) / 6], -1)
    pixels[(x // 40 + y // 40) % 2 == 0] += 60
    pixels[(x - 320) ** 2 + (y - 240) ** 2 < 120**2] = (200, 120, 90)
    pixels += np.random.default_rng(1).normal(0, 3, pixels.shape)
    return yarpy.Image(pixels.clip(0, 255).astype("u1"))


@contextmanager
def elsewhere(*args: str) -> Iterator[subprocess.Popen[str]]:
    """A program on the second core."""
    core = [] if len(os.sched_getaffinity(0)) < 2 else ["taskset", "-c", str(max(CORES))]
    with subprocess.Popen([*core, *args], stdout=subprocess.PIPE, text=True) as process:
        yield process
        process.terminate()


def watch(address: str, interval: float) -> None:
    """Count the pictures that come, as a process of its own; prints how many a second, every
    `interval` seconds, or when at least one has come."""
    host, _, port = address.rpartition(":")
    sock = socket.create_connection((host, int(port)))
    sock.sendall(f"GET /?action=stream HTTP/1.1\r\nHost: {address}\r\n\r\n".encode())
    marks, last, rest = 0, time.monotonic(), b""
    mark = b"\n--boundarydonotcross\r\n"
    while data := sock.recv(1 << 20):
        data = rest + data
        marks += data.count(mark)
        rest = data[-len(mark) + 1 :]
        now = time.monotonic()
        if marks and now - last >= interval:
            print(marks / (now - last), flush=True)
            marks, last = 0, now


def pictures(reports: int, watchers: int, interval: float = 1.0) -> tuple[float, float]:
    """Pictures a second that each watcher sees, over so many intervals, and the port's milliseconds
    for each written."""
    image = picture()
    with yarpy.Port("/cam", names=yarpy.LocalNames()) as port:
        rates: list[list[float]] = [[] for _ in range(watchers)]

        def count(index: int) -> None:
            watching = [sys.executable, __file__, "--watch", port.address]
            with elsewhere(*watching, "--interval", str(interval)) as process:
                assert process.stdout is not None
                for line in process.stdout:
                    rates[index].append(float(line))
                    if len(rates[index]) > reports:  # in the first the others are still coming
                        return

        threads = [threading.Thread(target=count, args=(index,)) for index in range(watchers)]
        for thread in threads:
            thread.start()
        assert port.wait_for_outputs(watchers, timeout=30), "the browsers do not come"
        started, before = time.process_time(), 0
        while any(thread.is_alive() for thread in threads):
            if not port.write(image):
                time.sleep(0.0005)  # the last one has not left yet
            else:
                before += 1
        spent = (time.process_time() - started) / max(before, 1)
    whole = [sum(each[1:]) / reports for each in rates]
    return sum(whole) / watchers, spent * 1000


def requests(seconds: float, connections: int) -> tuple[float, float] | None:
    """Requests a second, and the port's microseconds for each; None without wrk."""
    if not shutil.which("wrk"):
        return None
    names = yarpy.LocalNames()
    with yarpy.RpcServer("/rpc", lambda m: ["is", "encs", [0.0, 45.0, 0.0]], names=names) as port:
        url = f"http://{port.address}/?req=get+encs"
        many = ["-t", "1", "-c", str(connections), "-d", f"{seconds:g}"]
        started = time.process_time()
        with elsewhere("wrk", *many, url) as process:
            said = process.communicate()[0]
        spent = time.process_time() - started
        rate = float(said.partition("Requests/sec:")[2].split()[0])
        served = int(said.partition(" requests in")[0].split()[-1])
    return rate, spent / served * 1e6


CORES = sorted(os.sched_getaffinity(0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--watch", metavar="ADDRESS", help=argparse.SUPPRESS)
    parser.add_argument("--interval", type=float, default=1.0, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.watch:
        watch(options.watch, options.interval)
        return
    os.sched_setaffinity(0, {CORES[0]})
    seconds = max(1.0, options.seconds)
    print(f"{'':32}{'per second':>12}{'core time':>14}")
    for watchers in (1, 4):
        rate, cost = pictures(round(seconds), watchers)
        what = f"pictures, {watchers} browser{'s' * (watchers > 1)}"
        print(f"{what:32}{rate:12.0f}{cost:11.2f} ms")
    for connections in (1, 8):
        found = requests(seconds, connections)
        if found is None:
            print("requests: wrk is not installed (apt-get install wrk)")
            return
        what = f"requests, {connections} connection{'s' * (connections > 1)}"
        print(f"{what:32}{found[0]:12.0f}{found[1]:11.0f} us")


if __name__ == "__main__":
    main()
