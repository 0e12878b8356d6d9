"""Peer: the C++ program `yarp latency-test`, no Python in the measured path.

$YARP_PROGRAM names the program; a C++ name server must be configured. It sends an int and a float
and gets them back with a short string added, over two streams (`--no-reply`) or as request and
reply, and writes the milliseconds of each exchange to a file.
"""

import os
import subprocess
import tempfile
import time
from pathlib import Path

from peer import main, ready

PAYLOAD = 8  # bytes of the string that the server adds


def run(*args):
    return [os.environ["YARP_PROGRAM"], "latency-test", *args]


def serve(options):
    # The program has one fixed port name; the name server forgets the one before.
    server = subprocess.Popen(run("--server"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while subprocess.run(
        [os.environ["YARP_PROGRAM"], "exists", "/latencyTest/server"], stdout=subprocess.DEVNULL
    ).returncode:
        time.sleep(0.05)
    ready()
    server.wait()


def client(options, *mode):
    with tempfile.TemporaryDirectory() as directory:
        frames = ("--nframes", str(options.warmup + options.count), "--payload_size", str(PAYLOAD))
        how = ("--protocol", options.carrier, "--logfile", f"{directory}/log", *mode)
        if options.pause:
            how = (*how, "--client_wait", str(options.pause))
        subprocess.run(run("--client", *frames, *how), check=True, stdout=subprocess.DEVNULL)
        rows = Path(directory, f"log{PAYLOAD}.txt").read_text(encoding="utf-8").splitlines()
    return [int(float(row.split()[0]) * 1e6) for row in rows[options.warmup :]]


if __name__ == "__main__":
    main(
        {
            "stream": (serve, lambda options: client(options, "--no-reply")),
            "rpc": (serve, client),
        }
    )
