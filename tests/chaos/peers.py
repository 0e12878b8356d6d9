"""The programs that get killed: one writes numbers, one reads them.

    python peers.py write OUT IN CARRIER HZ [jump]      until end of input; prints its counters
    python peers.py read IN [PAUSE]                     prints every number as it comes
    python peers.py crowd PORT COUNT SECONDS WORD       connections that say WORD and stay; prints
                                                        how many are there, and leaves at the end

Rules: a number is printed with a system call of its own, so that a killed reader has told all it
read. `jump` sets the wall clock that the program sees an hour back or forth every second.
"""

import json
import os
import resource
import socket
import sys
import threading
import time

import yarpy


def say(text: str) -> None:
    os.write(1, f"{text}\n".encode())


def jump() -> None:
    """Let the wall clock leap. Monotonic time goes on, as it does when somebody sets the clock."""
    real, since = time.time, time.monotonic()

    def leaping() -> float:
        return real() + 3600 * (int(time.monotonic() - since) % 3 - 1)

    time.time = leaping


def write(out: str, target: str, carrier: str, hertz: str, *options: str) -> None:
    if "jump" in options:
        jump()
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    with yarpy.BufferedPort(out, strict=True) as port:
        if target:
            port.connect(target, carrier)
        say("ready")
        number = 0
        while not ended.wait(1 / float(hertz)):
            if port.outputs:
                port.write([number])
                number += 1
        port.flush(timeout=5)
        stats = port.stats
        port.disconnect(target)
        past = port.stats.past.outputs
    told = {"written": number, "drops": past.drops + stats.unconnected}
    say(json.dumps({**told, "unconfirmed": past.unconfirmed}))


def read(name: str, pause: str = "0") -> None:
    with yarpy.BufferedPort(name, strict=True) as port:
        say("ready")
        while True:
            say(str(port.read().value[0]))
            time.sleep(float(pause))


def crowd(port: str, count: str, seconds: str, word: str) -> None:
    """From many addresses of this computer, as one has 28 000 port numbers at most."""
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    say("ready")
    crowd, started = [], time.monotonic()
    for number in range(int(count)):
        time.sleep(max(0.0, started + float(seconds) * number / int(count) - time.monotonic()))
        try:
            source = (f"127.0.1.{number % 200 + 1}", 0)
            crowd.append(socket.create_connection(("127.0.0.1", int(port)), 5, source))
            crowd[-1].sendall(word.encode())
        except OSError:
            pass  # refused
    say(str(len(crowd)))
    sys.stdin.read()


if __name__ == "__main__":
    {"write": write, "read": read, "crowd": crowd}[sys.argv[1]](*sys.argv[2:])
