"""A listener: asks the talker to send to it, and prints what arrives.

In three terminals:

    yarpy server
    python examples/talker.py
    python examples/listener.py

The talker may be started later: the listener waits for it. If the talker crashes and is started
again, its messages come again. Ctrl-C ends the listener; `python examples/listener.py 5` stops
after 5 messages.
"""

import sys
from contextlib import suppress

import yarpy


def main() -> None:
    limit = int(sys.argv[1]) if len(sys.argv) > 1 else sys.maxsize
    with yarpy.Port("/listener") as port:
        yarpy.wait_for("/talker")
        port.listen_to("/talker")
        for number, message in enumerate(port, start=1):
            print(message.source, message.value, message.stamp, flush=True)
            if number == limit:
                break


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        main()
