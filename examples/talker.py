"""A talker: ten times a second it sends a number and a word to every connected port.

In three terminals:

    yarpy server
    python examples/talker.py
    python examples/listener.py

Ctrl-C ends it. `python examples/talker.py 20` stops after 20 messages.
"""

import sys
import time
from contextlib import suppress

import yarpy


def main() -> None:
    limit = int(sys.argv[1]) if len(sys.argv) > 1 else sys.maxsize
    with yarpy.Port("/talker") as port:
        print(f"{port.name} listens at {port.address}", flush=True)
        stamp = yarpy.Stamp()
        while stamp.count + 1 < limit:
            stamp = stamp.next(time.time())
            port.write([stamp.count, "hello"], stamp)
            time.sleep(0.1)


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        main()
