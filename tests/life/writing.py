"""A program that writes numbered messages until its standard input ends: ADDRESS CARRIER SIZE RATE.

Each is a list of its number and some bytes; RATE is messages a second, or `flood`.
"""

import sys
import threading
import time

from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port


def main() -> None:
    address, carrier, size, rate = sys.argv[1:]
    over = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), over.set()), daemon=True).start()
    body, number = bytes(int(size)), 0
    pause = 0.0 if rate == "flood" else 1 / float(rate)
    with Port("/out", names=LocalNames()) as out:
        out.connect("/" + address, carrier)
        due = time.perf_counter()
        while not over.is_set():
            if out.write([number, body]):
                number += 1
            else:
                time.sleep(0.001)
            due += pause
            if pause and (left := due - time.perf_counter()) > 0:
                time.sleep(left)
            elif carrier == "udp" and not pause:
                time.sleep(0.00005)


main()
